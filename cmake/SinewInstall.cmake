# Install rules: library, headers, command, robot files, schemas and study files, and a CMake package for
# find_package(sinew).
include(CMakePackageConfigHelpers)
set(sinew_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/sinew)
set(sinew_data_dir ${CMAKE_INSTALL_DATADIR}/sinew)

install(TARGETS sinew sinew_kernel EXPORT sinewTargets FILE_SET HEADERS)
install(EXPORT sinewTargets NAMESPACE sinew:: DESTINATION ${sinew_package_dir})

if(TARGET sinew_command)
  if(BUILD_SHARED_LIBS)
    file(RELATIVE_PATH sinew_bin_to_lib ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBDIR})
    set_target_properties(sinew_command PROPERTIES INSTALL_RPATH "$ORIGIN/${sinew_bin_to_lib}")
  endif()
  install(TARGETS sinew_command)
endif()
foreach(folder robots schema studies)
  if(IS_DIRECTORY ${PROJECT_SOURCE_DIR}/${folder})
    install(DIRECTORY ${PROJECT_SOURCE_DIR}/${folder} DESTINATION ${sinew_data_dir})
  endif()
endforeach()
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})

# What a consumer has to find is read off the exported target: its public libraries, and in a static library the
# private ones too ($<LINK_ONLY:...>).
set(sinew_package_of_Eigen3::Eigen "Eigen3 3.4")
set(sinew_package_of_tl::expected "tl-expected")
set(sinew_package_of_fmt::fmt "fmt")
set(sinew_package_of_nlohmann_json::nlohmann_json "nlohmann_json")
set(sinew_package_of_yaml-cpp "yaml-cpp")
set(sinew_package_of_hwy::hwy "hwy")
set(sinew_package_of_Threads::Threads "Threads")
set(sinew_package_of_TBB::tbb "TBB")
set(SINEW_DEPENDENCIES "")
get_target_property(sinew_libraries sinew INTERFACE_LINK_LIBRARIES)
foreach(library IN LISTS sinew_libraries)
  string(REGEX REPLACE "^\\$<LINK_ONLY:(.*)>$" "\\1" library "${library}")
  if(library MATCHES "^sinew::|BUILD_INTERFACE" OR NOT library MATCHES "[A-Za-z]")
    continue()
  elseif(NOT DEFINED sinew_package_of_${library})
    if(library MATCHES "::" OR TARGET ${library})
      message(FATAL_ERROR "sinew links ${library}: name its package in cmake/SinewInstall.cmake, "
                          "or an installed sinew cannot be found")
    endif()
  else()
    string(APPEND SINEW_DEPENDENCIES "find_dependency(${sinew_package_of_${library}})\n")
  endif()
endforeach()

configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/sinewConfig.cmake.in ${PROJECT_BINARY_DIR}/sinewConfig.cmake
  INSTALL_DESTINATION ${sinew_package_dir} PATH_VARS sinew_data_dir)
if(PROJECT_VERSION_MAJOR EQUAL 0)
  set(sinew_compatibility SameMinorVersion)
else()
  set(sinew_compatibility SameMajorVersion)
endif()
write_basic_package_version_file(${PROJECT_BINARY_DIR}/sinewConfigVersion.cmake COMPATIBILITY ${sinew_compatibility})
install(FILES ${PROJECT_BINARY_DIR}/sinewConfig.cmake ${PROJECT_BINARY_DIR}/sinewConfigVersion.cmake
  DESTINATION ${sinew_package_dir})
