# The page of sinew serve in a real browser; screenshots are in build/PRESET/screenshots.
find_program(CHROMIUM chromium)
mark_as_advanced(CHROMIUM)
if(SINEW_WEB AND CHROMIUM)
  add_test(NAME web.page COMMAND ${NODE} ${PROJECT_SOURCE_DIR}/web/test/page.mjs $<TARGET_FILE:sinew_command> ${CHROMIUM}
                                 ${CMAKE_BINARY_DIR}/screenshots)
  set_tests_properties(web.page PROPERTIES LABELS web TIMEOUT 1200 COST 1000)  # the longest begins first
else()
  message(STATUS "The page is not tested: that needs SINEW_WEB, Node and Debian's chromium")
endif()
