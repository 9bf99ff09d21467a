# Outside headers that most sources include, parsed once and not once a source: a cold build takes
# two thirds of the time. With gcc alone, so that a build with clang still finds a source that
# does not include what it uses. No header of leonav's is here: which folder sees which is checked
# by the include paths. gcc 12 then takes a sum that begins with a constant, std::string("a") + b, for
# an access out of bounds in some places: begin with b, or append.
option(LEONAV_PRECOMPILE "Precompile the outside headers that most sources include" ON)

# Users of Boost.Headers get this definition; a precompiled header serves those with equal ones.
add_compile_definitions(BOOST_ALL_NO_LIB)

# leonav_precompiled(kind header...): what leonav_precompile(target kind) uses.
function(leonav_precompiled kind)
  set(target leonav_precompiled_${kind})
  set(source ${CMAKE_BINARY_DIR}/generated/${target}.cc)
  file(CONFIGURE OUTPUT ${source} CONTENT "// Compiled for its precompiled header.\n")
  add_library(${target} OBJECT ${source})
  target_link_libraries(${target} PRIVATE Eigen3::Eigen Boost::headers)
  target_precompile_headers(${target} PRIVATE ${ARGN})
endfunction()

# Not where LCM's types may be used: these need -fno-strict-aliasing (targets.cmake), which gcc
# forgets, without a word, behind a header that was precompiled without it.
function(leonav_precompile target kind folder)
  if(LEONAV_PRECOMPILE AND CMAKE_CXX_COMPILER_ID STREQUAL GNU AND
     folder MATCHES "^(test/)?core/|^drivers/" AND NOT folder STREQUAL drivers/lcm)
    target_precompile_headers(${target} REUSE_FROM leonav_precompiled_${kind})
  endif()
endfunction()

if(LEONAV_PRECOMPILE AND CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  set(common <algorithm> <array> <cmath> <cstdint> <functional> <limits> <map> <memory> <numbers> <optional> <span>
      <string> <string_view> <utility> <variant> <vector> <boost/container/static_vector.hpp>)
  leonav_precompiled(library ${common} <Eigen/Core> <Eigen/Geometry> <Eigen/Cholesky>)
  if(BUILD_TESTING)
    leonav_precompiled(test ${common} <filesystem> <fstream> <iostream> <random> <sstream> <Eigen/Dense>
                       ${CMAKE_SOURCE_DIR}/test/support/catch.h)
    find_package(Catch2 REQUIRED)
    target_link_libraries(leonav_precompiled_test PRIVATE Catch2::Catch2)
  endif()
endif()
