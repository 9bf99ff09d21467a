# What `cmake --install` installs, and the Debian packages of `cpack -G DEB`: the component leonav is what a vehicle
# needs, the component leonav-dev what a program needs that embeds the navigator. tools/packaging/README.md tells the rest.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME leonav)

# leonav_add_parts(list target...): appends the targets and those of the tree that they are linked to.
function(leonav_add_parts list)
  set(found ${${list}})
  foreach(target ${ARGN})
    if(target IN_LIST found OR NOT target MATCHES "^(core|drivers|daemon)_")
      continue()
    endif()
    list(APPEND found ${target})
    get_target_property(links ${target} INTERFACE_LINK_LIBRARIES)
    string(REGEX REPLACE "\\$<LINK_ONLY:([^>]*)>" "\\1" links "${links}")
    leonav_add_parts(found ${links})
  endforeach()
  set(${list} ${found} PARENT_SCOPE)
endfunction()

# --- the programs ---
get_property(programs GLOBAL PROPERTY leonav_programs)
install(TARGETS ${programs} RUNTIME)

# The interpreted ones find each other, the message types and the version by the tree's own layout.
set(share ${CMAKE_INSTALL_DATADIR}/leonav)
install(FILES VERSION DESTINATION ${share})
foreach(folder report fleet top python)
  install(DIRECTORY tools/${folder} DESTINATION ${share}/tools USE_SOURCE_PERMISSIONS
          PATTERN __pycache__ EXCLUDE PATTERN "*.egg-info" EXCLUDE PATTERN README.md EXCLUDE
          PATTERN setup.py EXCLUDE PATTERN pyproject.toml EXCLUDE)
endforeach()
install(DIRECTORY lcmtypes DESTINATION ${share} FILES_MATCHING PATTERN "*.lcm" PATTERN README.md)
install(DIRECTORY config/presets config/scenario config/matrix DESTINATION ${share} FILES_MATCHING PATTERN "*.yaml")
install(FILES config/reference.yaml config/dataset.yaml DESTINATION ${share})
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs/images DESTINATION ${CMAKE_INSTALL_DOCDIR})

# Paths in units and pages depend on the prefix, which is known when it is installed; manuals are made by the programs.
get_property(scripts GLOBAL PROPERTY leonav_scripts)
install(CODE "
  set(source \"${CMAKE_SOURCE_DIR}\")
  set(build \"${CMAKE_BINARY_DIR}\")
  set(version ${PROJECT_VERSION})
  set(programs ${programs})
  set(scripts ${scripts})")
install(SCRIPT cmake/install_generated.cmake)

# --- embedding: the navigator, its configuration and its messages as one library ---
leonav_add_parts(parts core_navigator daemon_config daemon_messages)
set(objects)
set(folders)
foreach(part ${parts})
  get_target_property(type ${part} TYPE)
  if(NOT type STREQUAL INTERFACE_LIBRARY)
    list(APPEND objects $<TARGET_OBJECTS:${part}>)
  endif()
  get_property(folder GLOBAL PROPERTY leonav_folder_of_${part})
  list(APPEND folders ${folder})
endforeach()
add_library(leonav_embedded STATIC ${objects})
set_target_properties(leonav_embedded PROPERTIES OUTPUT_NAME leonav EXPORT_NAME leonav LINKER_LANGUAGE CXX)
target_include_directories(leonav_embedded SYSTEM INTERFACE
  $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/leonav> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
target_compile_features(leonav_embedded INTERFACE cxx_std_20)
# Code in headers must give the same bits as the library; cmake/targets.cmake says why without strict aliasing.
target_compile_options(leonav_embedded INTERFACE -ffp-contract=off -fno-strict-aliasing)
install(TARGETS leonav_embedded EXPORT leonav ARCHIVE COMPONENT leonav-dev)
# Debug information of the library is four times its code.
install(CODE "
  if(CMAKE_INSTALL_DO_STRIP)
    execute_process(COMMAND \"${CMAKE_STRIP}\" --strip-debug --enable-deterministic-archives
      \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_LIBDIR}/libleonav.a\" COMMAND_ERROR_IS_FATAL ANY)
  endif()" COMPONENT leonav-dev)
foreach(folder ${folders})
  file(GLOB headers CONFIGURE_DEPENDS ${folder}/*.h)
  install(FILES ${headers} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/leonav/${folder} COMPONENT leonav-dev)
  # Classes of the chapter have members of these types.
  file(GLOB headers CONFIGURE_DEPENDS ${folder}/internal/*.h)
  if(headers)
    install(FILES ${headers} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/leonav/${folder}/internal COMPONENT leonav-dev)
  endif()
endforeach()
install(DIRECTORY ${CMAKE_BINARY_DIR}/generated/leonav DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
        COMPONENT leonav-dev FILES_MATCHING PATTERN "*.hpp")

set(config_folder ${CMAKE_INSTALL_LIBDIR}/cmake/leonav)
install(EXPORT leonav NAMESPACE leonav:: FILE leonav-targets.cmake DESTINATION ${config_folder} COMPONENT leonav-dev)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/leonav-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES cmake/leonav-config.cmake ${CMAKE_BINARY_DIR}/leonav-config-version.cmake
        DESTINATION ${config_folder} COMPONENT leonav-dev)

include(cmake/debian.cmake)
