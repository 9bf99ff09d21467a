# Outside packages, all from Debian. LCM and Nettle ship no CMake config, so they are found by hand.
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(Boost REQUIRED)
find_package(OpenSSL 3.0 REQUIRED)
find_package(Ceres 2.1 REQUIRED)
find_package(Threads REQUIRED)
find_package(yaml-cpp REQUIRED)
find_package(spdlog REQUIRED)
find_path(LCM_INCLUDE_DIR lcm/lcm-cpp.hpp REQUIRED)
find_library(LCM_LIBRARY lcm REQUIRED)
find_program(LCM_GEN lcm-gen REQUIRED)

add_library(lcm INTERFACE)
target_include_directories(lcm SYSTEM INTERFACE ${LCM_INCLUDE_DIR})
target_link_libraries(lcm INTERFACE ${LCM_LIBRARY})

# Static, because leonavd locks whole libraries in memory (daemon/commands/README.md).
find_path(NETTLE_INCLUDE_DIR nettle/hmac.h REQUIRED)
find_library(NETTLE_LIBRARY libnettle.a REQUIRED)

add_library(nettle INTERFACE)
target_include_directories(nettle SYSTEM INTERFACE ${NETTLE_INCLUDE_DIR})
target_link_libraries(nettle INTERFACE ${NETTLE_LIBRARY})
