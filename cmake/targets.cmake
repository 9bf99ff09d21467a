# One target per folder. A folder's headers are reachable only through its target: each target's
# include path holds links to the headers of its own folder and nothing else, so that a forbidden
# include does not compile. Headers in a folder's internal/ are for that folder and its tests alone,
# which test/structure/purity checks.

# A link that an earlier layout left there could lead into the sources, and be written through.
file(REMOVE_RECURSE ${CMAKE_BINARY_DIR}/include)

# leonav_expose(target path): a header, or the headers of a folder and of its internal/.
function(leonav_expose target path)
  set(root ${CMAKE_BINARY_DIR}/include/${target})
  if(IS_DIRECTORY ${CMAKE_SOURCE_DIR}/${path})
    file(GLOB headers CONFIGURE_DEPENDS RELATIVE ${CMAKE_SOURCE_DIR}
         ${CMAKE_SOURCE_DIR}/${path}/*.h ${CMAKE_SOURCE_DIR}/${path}/internal/*.h)
  else()
    set(headers ${path})
  endif()
  foreach(header ${headers})
    cmake_path(GET header PARENT_PATH parent)
    file(MAKE_DIRECTORY ${root}/${parent})
    file(CREATE_LINK ${CMAKE_SOURCE_DIR}/${header} ${root}/${header} SYMBOLIC)
  endforeach()
  get_target_property(type ${target} TYPE)
  if(type STREQUAL INTERFACE_LIBRARY)
    target_include_directories(${target} INTERFACE ${root})
  else()
    target_include_directories(${target} PUBLIC ${root})
  endif()
endfunction()

# leonav_library(target folder [DEPENDS public...] [PRIVATE private...]): every source of the folder
# and of its internal/ but main.cc.
function(leonav_library target folder)
  cmake_parse_arguments(ARG "" "" "DEPENDS;PRIVATE" ${ARGN})
  set_property(GLOBAL PROPERTY leonav_folder_of_${target} ${folder})  # for cmake/install.cmake
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/${folder}/*.cc
       ${CMAKE_SOURCE_DIR}/${folder}/internal/*.cc)
  list(FILTER sources EXCLUDE REGEX "/main\\.cc$")
  if(NOT sources)  # headers only
    add_library(${target} INTERFACE)
    target_link_libraries(${target} INTERFACE ${ARG_DEPENDS})
  else()
    add_library(${target} STATIC ${sources})
    target_link_libraries(${target} PUBLIC ${ARG_DEPENDS} PRIVATE ${ARG_PRIVATE})
    leonav_precompile(${target} library ${folder})
    # libFuzzer is told of what formats compare bytes with. What the others compare are numbers, of which it learns nothing,
    # and texts, by functions of the library that tell it anyway; telling takes up to half of the time.
    if(LEONAV_FUZZ AND (NOT folder MATCHES "^drivers/" OR folder MATCHES "^drivers/(text|yaml)$"))
      target_compile_options(${target} PRIVATE -fno-sanitize-coverage=trace-cmp)
    endif()
  endif()
  leonav_expose(${target} ${folder})
endfunction()

# leonav_chapter(target DEPENDS ...): the libraries of a folder's folders under one name.
function(leonav_chapter target)
  cmake_parse_arguments(ARG "" "" "DEPENDS" ${ARGN})
  add_library(${target} INTERFACE)
  target_link_libraries(${target} INTERFACE ${ARG_DEPENDS})
endfunction()

# leonav_program(target folder [DEPENDS ...]): the folder's main.cc.
function(leonav_program target folder)
  cmake_parse_arguments(ARG "" "" "DEPENDS" ${ARGN})
  add_executable(${target} ${CMAKE_SOURCE_DIR}/${folder}/main.cc)
  target_link_libraries(${target} PRIVATE ${ARG_DEPENDS})
  set_property(GLOBAL APPEND PROPERTY leonav_programs ${target})
endfunction()

# leonav_scripts(folder name...): interpreted tools, linked beside the programs.
function(leonav_scripts folder)
  file(MAKE_DIRECTORY ${CMAKE_RUNTIME_OUTPUT_DIRECTORY})
  foreach(name ${ARGN})
    if(EXISTS ${CMAKE_SOURCE_DIR}/${folder}/${name})
      file(CREATE_LINK ${CMAKE_SOURCE_DIR}/${folder}/${name} ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}/${name} SYMBOLIC)
      set_property(GLOBAL APPEND PROPERTY leonav_scripts ${folder}/${name})
    endif()
  endforeach()
endfunction()

# leonav_lcm_types(target): C++ (and, where asked, other languages') types from lcmtypes/*.lcm.
function(leonav_lcm_types target)
  file(GLOB definitions CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/lcmtypes/*.lcm)
  set(out ${CMAKE_BINARY_DIR}/generated)
  set(headers)
  foreach(definition ${definitions})
    cmake_path(GET definition STEM stem)
    list(APPEND headers ${out}/leonav/${stem}.hpp)
  endforeach()
  add_custom_command(
    OUTPUT ${headers}
    COMMAND ${LCM_GEN} --cpp --cpp-hpath ${out} --cpp-std=c++11 ${definitions}
    DEPENDS ${definitions}
    COMMENT "lcm-gen")
  add_custom_target(${target}_generate DEPENDS ${headers})
  add_library(${target} INTERFACE)
  add_dependencies(${target} ${target}_generate)
  target_include_directories(${target} SYSTEM INTERFACE ${out})
  # liblcm's coding functions reach doubles through int64_t pointers; under strict aliasing gcc 12
  # -O2 then decodes arrays of double as zeros.
  target_compile_options(${target} INTERFACE -fno-strict-aliasing)
  target_link_libraries(${target} INTERFACE lcm)
endfunction()

# leonav_embed_configuration(target): the presets and the reference of config/ as a source of target.
function(leonav_embed_configuration target)
  file(GLOB presets CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/config/presets/*.yaml)
  set(reference ${CMAKE_SOURCE_DIR}/config/reference.yaml)
  set(script ${CMAKE_SOURCE_DIR}/cmake/embed_configuration.cmake)
  set(out ${CMAKE_BINARY_DIR}/generated/embedded_configuration.cc)
  add_custom_command(
    OUTPUT ${out}
    COMMAND ${CMAKE_COMMAND} -DOUT=${out} -DREFERENCE=${reference} "-DPRESETS=${presets}" -P ${script}
    DEPENDS ${presets} ${reference} ${script}
    COMMENT "presets"
    VERBATIM)
  target_sources(${target} PRIVATE ${out})
endfunction()

# Catch2 with its main(), compiled once for all test programs.
function(leonav_catch2)
  if(TARGET catch2_with_main)
    return()
  endif()
  find_package(Catch2 REQUIRED)
  if(Catch2_VERSION VERSION_GREATER_EQUAL 3)
    add_library(catch2_with_main INTERFACE)
    target_link_libraries(catch2_with_main INTERFACE Catch2::Catch2WithMain)
    return()
  endif()
  add_library(catch2_with_main STATIC ${CMAKE_SOURCE_DIR}/test/support/catch2_main.cc)
  target_link_libraries(catch2_with_main PUBLIC Catch2::Catch2)
  # gcc 12 under the address sanitizer warns of the library's own std::function in <regex>.
  target_compile_options(catch2_with_main
                         PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
endfunction()

# leonav_test(target folder [DEPENDS ...] [EXCLUDE folder...] [APART source...]): one Catch2 program per folder,
# without the folders in it that have a program of their own; skipped while empty. What is in a source named behind APART
# is run as a test of its own, so that another processor can run it.
function(leonav_test target folder)
  cmake_parse_arguments(ARG "" "" "DEPENDS;EXCLUDE;APART" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/${folder}/*.cc)
  foreach(excluded ${ARG_EXCLUDE})
    list(FILTER sources EXCLUDE REGEX "^${CMAKE_SOURCE_DIR}/${excluded}/")
  endforeach()
  if(NOT sources)
    return()
  endif()
  leonav_catch2()
  add_executable(${target} ${sources})
  # Helpers of one chapter's tests lie at the top of its folder.
  target_include_directories(${target} PRIVATE ${CMAKE_SOURCE_DIR}/test ${CMAKE_SOURCE_DIR}/${folder})
  target_link_libraries(${target} PRIVATE catch2_with_main)
  leonav_precompile(${target} test ${folder})
  target_compile_definitions(${target} PRIVATE
    LEONAV_SHARED_DATA="${CMAKE_SOURCE_DIR}/../shared/data"
    LEONAV_SOURCE_DIR="${CMAKE_SOURCE_DIR}"
    LEONAV_BIN_DIR="${CMAKE_RUNTIME_OUTPUT_DIRECTORY}")
  target_link_libraries(${target} PRIVATE ${ARG_DEPENDS})
  if(LEONAV_SANITIZE)
    # gcc 12 knows less of values once a sanitizer has added its code: it takes members of std::regex for
    # uninitialized, and numbers of two digits for longer ones.
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized -Wno-format-truncation>)
  endif()
  set(tests ${target})
  set(rest "")
  foreach(source ${ARG_APART})
    if(NOT EXISTS ${CMAKE_SOURCE_DIR}/${folder}/${source}.cc)
      message(FATAL_ERROR "${target}: ${folder} has no ${source}.cc")
    endif()
    cmake_path(GET source FILENAME name)
    string(APPEND rest "~[#${name}]")
    add_test(NAME ${name} COMMAND ${target} --filenames-as-tags "[#${name}]")
    list(APPEND tests ${name})
  endforeach()
  if(rest)
    list(PREPEND rest --filenames-as-tags)
  endif()
  add_test(NAME ${target} COMMAND ${target} ${rest})
  set(limit_s 1800)  # for what hangs; the longest takes five to fifteen minutes
  if(LEONAV_SANITIZE)
    set(limit_s 3600)
  endif()
  set_tests_properties(${tests} PROPERTIES TIMEOUT ${limit_s})
endfunction()

# leonav_script_test(name script argument...): a test that is a script of the source tree.
function(leonav_script_test name script)
  add_test(NAME ${name} COMMAND ${CMAKE_SOURCE_DIR}/${script} ${ARGN})
  set_tests_properties(${name} PROPERTIES TIMEOUT 120)
endfunction()
