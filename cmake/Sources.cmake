# mmm_converter_sources(target folder...): all sources below the folders, so that a new file needs no line in a list.
# Files *_kernels.cc are compiled otherwise (InstructionSets.cmake).
function(mmm_converter_sources target)
  foreach(folder IN LISTS ARGN)
    file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${folder}/*.cc)
    list(FILTER sources EXCLUDE REGEX "_kernels\\.cc$")
    target_sources(${target} PRIVATE ${sources})
  endforeach()
endfunction()
