# The Debian packages: `tools/package`, or `cpack -G DEB` in the folder of a release build.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME leonav)
set(CPACK_PACKAGE_VENDOR leonav)
set(LEONAV_MAINTAINER "leonav maintainers <leonav@users.noreply.github.com>" CACHE STRING "Maintainer of the Debian packages")
set(CPACK_PACKAGE_CONTACT ${LEONAV_MAINTAINER})
set(CPACK_COMPONENTS_ALL leonav leonav-dev)
# The same version of leonav made for the next release of Debian is another package, and a newer one: 0.1.0~deb12, 0.1.0~deb13.
set(package_version ${PROJECT_VERSION})
cmake_host_system_information(RESULT distribution QUERY DISTRIB_INFO)
if(distribution_VERSION_ID)
  string(REPLACE debian deb name ${distribution_ID})
  string(APPEND package_version "~${name}${distribution_VERSION_ID}")
endif()
set(CPACK_DEBIAN_PACKAGE_VERSION ${package_version})
# The prefix of a package is /usr whatever that of the build is, and there are files in /etc.
set(CPACK_SET_DESTDIR ON)
set(CPACK_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)

set(scripts tools/packaging/debian)
set(CPACK_DEBIAN_LEONAV_PACKAGE_NAME leonav)
set(CPACK_DEBIAN_LEONAV_PACKAGE_SECTION science)
set(CPACK_COMPONENT_LEONAV_DESCRIPTION "navigation service for vehicles
leonav finds where a vehicle is, how fast it moves and how it is oriented.
The service leonavd fuses an IMU with raw GNSS measurements, and with ranging
from low-Earth-orbit satellites where there is any. It talks LCM: measurements
come in as messages, solutions and health go out as messages. Every run can
write a journal that replays bit for bit.

The package holds the services for systemd, which the administrator enables,
and the tools that import, simulate, replay, judge and show runs.")
# shlibdeps adds the libraries. Which Python modules a tool needs, it says itself. A vehicle needs leonav-top and lcm-logplayer;
# pictures and tables would bring 1.6 GB: matplotlib and pandas recommend a compiler, among others.
set(CPACK_DEBIAN_LEONAV_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_LEONAV_PACKAGE_DEPENDS "python3, iproute2, systemd | systemd-standalone-sysusers")
set(CPACK_DEBIAN_LEONAV_PACKAGE_RECOMMENDS "python3-numpy, liblcm-bin")
set(CPACK_DEBIAN_LEONAV_PACKAGE_SUGGESTS "python3-matplotlib, python3-pandas, python3-yaml, default-jre, liblcm-java, libjchart2d-java, python3-distributed, gpsd")
set(CPACK_DEBIAN_LEONAV_PACKAGE_CONTROL_EXTRA
    ${CMAKE_SOURCE_DIR}/${scripts}/conffiles ${CMAKE_SOURCE_DIR}/${scripts}/postinst
    ${CMAKE_SOURCE_DIR}/${scripts}/prerm ${CMAKE_SOURCE_DIR}/${scripts}/postrm)

set(CPACK_DEBIAN_LEONAV-DEV_PACKAGE_NAME leonav-dev)
set(CPACK_DEBIAN_LEONAV-DEV_PACKAGE_SECTION libdevel)
set(CPACK_COMPONENT_LEONAV-DEV_DESCRIPTION "library for programs that embed leonav's navigator
Headers, a static library with its CMake configuration (find_package(leonav)),
and the C++ types of leonav's LCM messages.")
set(CPACK_DEBIAN_LEONAV-DEV_PACKAGE_DEPENDS "libeigen3-dev (>= 3.4), libboost-dev, libceres-dev (>= 2.1), libyaml-cpp-dev, liblcm-dev")

# What Debian's policy asks of both.
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
foreach(package leonav leonav-dev)
  set(doc ${CMAKE_INSTALL_DATADIR}/doc/${package})
  install(FILES tools/packaging/debian/copyright DESTINATION ${doc} COMPONENT ${package})
  file(WRITE ${CMAKE_BINARY_DIR}/debian/${package}/changelog
    "leonav (${package_version}) unstable; urgency=medium\n\n  * Built from the sources of version ${PROJECT_VERSION}.\n\n"
    " -- ${LEONAV_MAINTAINER}  ${date}\n")
  execute_process(COMMAND gzip -9nf ${CMAKE_BINARY_DIR}/debian/${package}/changelog COMMAND_ERROR_IS_FATAL ANY)
  install(FILES ${CMAKE_BINARY_DIR}/debian/${package}/changelog.gz DESTINATION ${doc} COMPONENT ${package})
endforeach()

include(CPack)
