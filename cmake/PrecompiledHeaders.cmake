# Headers of other projects, parsed once for each group of targets instead of once for each source: half of the time of a
# build. A source still includes what it uses.
set(MMM_CONVERTER_STABLE_HEADERS
  <algorithm> <chrono> <cmath> <filesystem> <functional> <limits> <map> <memory> <optional> <random> <set> <string> <string_view>
  <utility> <vector> <Eigen/Cholesky> <Eigen/Core> <Eigen/Geometry> <fmt/format.h>)

# mmm_converter_header_group(group HEADERS <header>... LIBS <library>...): precompiles the stable headers and these.
function(mmm_converter_header_group group)
  cmake_parse_arguments(PARSE_ARGV 1 ARG "" "" "HEADERS;LIBS")
  file(WRITE ${PROJECT_BINARY_DIR}/${group}.cc "")
  add_library(${group} OBJECT ${PROJECT_BINARY_DIR}/${group}.cc)
  target_link_libraries(${group} PRIVATE Eigen3::Eigen fmt::fmt ${ARG_LIBS})
  target_compile_definitions(${group} PRIVATE EIGEN_STACK_ALLOCATION_LIMIT=1048576)
  mmm_converter_warnings(${group})  # g++ takes precompiled headers of the same options only
  target_precompile_headers(${group} PRIVATE ${MMM_CONVERTER_STABLE_HEADERS} ${ARG_HEADERS})
endfunction()

# mmm_converter_use_headers(target group): a target takes the headers of a group, and with them their libraries' definitions.
function(mmm_converter_use_headers target group)
  target_precompile_headers(${target} REUSE_FROM ${group})
  target_link_libraries(${target} PRIVATE fmt::fmt)
  target_compile_definitions(${target} PRIVATE EIGEN_STACK_ALLOCATION_LIMIT=1048576)
  get_target_property(type ${target} TYPE)
  if(type STREQUAL EXECUTABLE)
    target_compile_options(${target} PRIVATE -fPIC)  # as the group, instead of -fPIE
  endif()
endfunction()
