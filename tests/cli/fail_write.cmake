# Fails the N-th write of the command: what a full disc leaves (output_test.cpp).
add_library(sinew_fail_write MODULE ${CMAKE_CURRENT_LIST_DIR}/fail_write.cpp)
target_link_libraries(sinew_fail_write PRIVATE ${CMAKE_DL_LIBS})
target_compile_features(sinew_fail_write PRIVATE cxx_std_20)
set_target_properties(sinew_fail_write PROPERTIES CXX_VISIBILITY_PRESET default)
add_dependencies(test_cli sinew_fail_write)
