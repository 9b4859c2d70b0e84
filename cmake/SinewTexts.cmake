# What the command says of itself, as files: the page for man and the completions of shells, made by the command that was
# just built. Included where it can run, that is not where it is built for another machine.
set(texts ${CMAKE_BINARY_DIR}/share)
set(text_programs sinew_command)
if(TARGET sinew_command_whole)
  list(APPEND text_programs sinew_command_whole)
endif()
set(text_files "")
function(sinew_text name folder)
  string(JOIN " " words ${ARGN})
  add_custom_command(OUTPUT ${texts}/${name}
    COMMAND ${CMAKE_COMMAND} -D PROGRAM=$<TARGET_FILE:sinew_command> "-D WORDS=${words}" -D FILE=${texts}/${name}
            -P ${PROJECT_SOURCE_DIR}/cmake/SinewCapture.cmake
    DEPENDS ${text_programs} ${PROJECT_SOURCE_DIR}/cmake/SinewCapture.cmake VERBATIM)
  list(APPEND text_files ${texts}/${name})
  set(text_files ${text_files} PARENT_SCOPE)
  if(SINEW_INSTALL)
    install(FILES ${texts}/${name} DESTINATION ${folder})
  endif()
endfunction()
sinew_text(sinew.1 ${CMAKE_INSTALL_MANDIR}/man1 help --man)
sinew_text(sinew ${CMAKE_INSTALL_DATADIR}/bash-completion/completions completion bash)
sinew_text(_sinew ${CMAKE_INSTALL_DATADIR}/zsh/site-functions completion zsh)
sinew_text(sinew.fish ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d completion fish)
add_custom_target(sinew_texts ALL DEPENDS ${text_files})
