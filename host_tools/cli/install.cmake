# What `cmake --install` and `cpack -G DEB` put in place: program, scenarios, models, documents, completion, manual pages.
include(GNUInstallDirs)
set(pages ${CMAKE_CURRENT_BINARY_DIR}/pages)
add_custom_command(OUTPUT ${pages}/man1/traction.1 ${pages}/traction.bash ${pages}/_traction
  COMMAND ${CMAKE_COMMAND} -E rm -rf ${pages}
  COMMAND ${CMAKE_COMMAND} -E make_directory ${pages}/man1
  COMMAND traction man --folder ${pages}/man1
  COMMAND traction completion bash > ${pages}/traction.bash
  COMMAND traction completion zsh > ${pages}/_traction
  DEPENDS traction VERBATIM)
add_custom_target(traction_pages ALL DEPENDS ${pages}/man1/traction.1)

set(share ${CMAKE_INSTALL_DATADIR})
install(TARGETS traction RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
foreach(folder scenarios models rovers schemas)
  if(IS_DIRECTORY ${PROJECT_SOURCE_DIR}/${folder})
    install(DIRECTORY ${PROJECT_SOURCE_DIR}/${folder} DESTINATION ${share}/traction)
  endif()
endforeach()
install(PROGRAMS ${PROJECT_SOURCE_DIR}/firmware/flash/start DESTINATION ${share}/traction/flash) # of every package
install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES ${PROJECT_SOURCE_DIR}/README.md ${PROJECT_SOURCE_DIR}/CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright)
install(DIRECTORY ${pages}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR})
install(FILES ${pages}/traction.bash DESTINATION ${share}/bash-completion/completions RENAME traction)
install(FILES ${pages}/_traction DESTINATION ${share}/zsh/vendor-completions)
