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
  if(kind MATCHES "_with_lcm$")
    target_compile_options(${target} PRIVATE -fno-strict-aliasing)
  endif()
endfunction()

# LCM's types need -fno-strict-aliasing (targets.cmake), which gcc forgets, without a word, behind a
# header that was precompiled without it. So every target outside the core and the formats, whether
# it uses them or not, is compiled with it and has a precompiled header of its own kind.
function(leonav_precompile target kind folder)
  if(NOT LEONAV_PRECOMPILE OR NOT CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    return()
  endif()
  if(NOT folder MATCHES "^(test/)?core/|^drivers/" OR folder STREQUAL drivers/lcm)
    target_compile_options(${target} PRIVATE -fno-strict-aliasing)
    string(APPEND kind _with_lcm)
  endif()
  target_precompile_headers(${target} REUSE_FROM leonav_precompiled_${kind})
endfunction()

if(LEONAV_PRECOMPILE AND CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  set(common <algorithm> <array> <cmath> <cstdint> <functional> <limits> <map> <memory> <numbers> <optional> <span>
      <string> <string_view> <utility> <variant> <vector> <boost/container/static_vector.hpp>)
  set(library ${common} <Eigen/Core> <Eigen/Geometry> <Eigen/Cholesky>)
  leonav_precompiled(library ${library})
  leonav_precompiled(library_with_lcm ${library})
  if(BUILD_TESTING)
    find_package(Catch2 REQUIRED)
    set(test ${common} <filesystem> <fstream> <iostream> <random> <sstream> <Eigen/Dense>
        ${CMAKE_SOURCE_DIR}/test/support/catch.h)
    foreach(kind test test_with_lcm)
      leonav_precompiled(${kind} ${test})
      target_link_libraries(leonav_precompiled_${kind} PRIVATE Catch2::Catch2)
    endforeach()
  endif()
endif()
