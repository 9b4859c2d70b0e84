# What sinew::study links beside sinew, as targets; read by the build and by an installed sinew.
include(CMakeFindDependencyMacro)
find_dependency(TBB)
find_dependency(PkgConfig)
foreach(module IN ITEMS libmd libxxhash hdf5)
  if(NOT TARGET PkgConfig::${module})
    pkg_check_modules(${module} REQUIRED QUIET IMPORTED_TARGET GLOBAL ${module})
  endif()
endforeach()
if(NOT TARGET sinew_hdf5_hl)
  # Dimension scales are in HDF5's second library, which its package file does not name.
  find_library(SINEW_HDF5_HL_LIBRARY NAMES hdf5_hl hdf5_serial_hl HINTS ${hdf5_LIBRARY_DIRS} REQUIRED)
  mark_as_advanced(SINEW_HDF5_HL_LIBRARY)
  add_library(sinew_hdf5_hl UNKNOWN IMPORTED GLOBAL)
  set_target_properties(sinew_hdf5_hl PROPERTIES IMPORTED_LOCATION "${SINEW_HDF5_HL_LIBRARY}"
                                                 INTERFACE_LINK_LIBRARIES PkgConfig::hdf5)
endif()
