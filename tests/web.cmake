# The page of sinew serve in a real browser; screenshots are in build/PRESET/screenshots.
# The shell is Chromium without windows of its own, and takes half of the time.
find_program(CHROMIUM NAMES chromium-headless-shell chromium)
mark_as_advanced(CHROMIUM)
if(SINEW_WEB AND CHROMIUM)
  # Each with a server and a browser of its own, so that they run beside each other. The longest tests begin first.
  set(web_robots robots)
  set(web_design design)
  set(web_honest honest speed)
  set(web_page errors looks arms notebook)
  set(web_operate operate log jog)
  if(TARGET sinew_plan)
    list(APPEND web_page plans drive)
  endif()
  foreach(name robots design honest page operate)
    add_test(NAME web.${name} COMMAND ${NODE} ${PROJECT_SOURCE_DIR}/web/test/page.mjs $<TARGET_FILE:sinew_command> ${CHROMIUM}
                                      ${CMAKE_BINARY_DIR}/screenshots ${web_${name}})
    set_tests_properties(web.${name} PROPERTIES LABELS web TIMEOUT 1200 COST 1000)
  endforeach()
  # In real time, at the firmware in simulation.
  add_test(NAME web.demo COMMAND ${NODE} ${PROJECT_SOURCE_DIR}/web/test/page.mjs $<TARGET_FILE:sinew_command> ${CHROMIUM}
                                 ${CMAKE_BINARY_DIR}/screenshots demo)
  set_tests_properties(web.demo PROPERTIES LABELS web TIMEOUT 600 RUN_SERIAL TRUE SKIP_REGULAR_EXPRESSION "demo: skipped")
  add_test(NAME web.pictures COMMAND ${NODE} ${PROJECT_SOURCE_DIR}/web/test/scene.mjs $<TARGET_FILE:sinew_command> ${CHROMIUM}
                                     ${CMAKE_BINARY_DIR}/screenshots/alone)
  set_tests_properties(web.pictures PROPERTIES LABELS web TIMEOUT 1200 COST 950)
else()
  message(STATUS "The page is not tested: that needs SINEW_WEB, Node and Debian's chromium-headless-shell")
endif()
