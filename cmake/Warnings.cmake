# Warnings for our own targets only: headers of other projects are included as system headers.
function(mmm_converter_warnings target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor
                                           -Woverloaded-virtual -Wcast-qual
                                           # 64-byte vectors never cross our library's border
                                           -Wno-psabi)
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    # g++ 12 warns of what std::string does inside (GCC bugs 105651, 105329, 105762)
    target_compile_options(${target} PRIVATE -Wno-restrict -Wno-array-bounds -Wno-stringop-overread
                                             -Wno-stringop-overflow)
  endif()
  if(MMM_CONVERTER_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
endfunction()
