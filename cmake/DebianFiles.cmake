# What Debian's policy wants in a package beside what is installed: terms, changelogs, and why lintian may say what it says.
set(debian ${PROJECT_BINARY_DIR}/generated/debian)
file(READ LICENSE license)
string(REGEX MATCH "Copyright \\(c\\) ([^\n]+)" ignored "${license}")
set(DM_COPYRIGHT ${CMAKE_MATCH_1})
string(REGEX REPLACE "^.*Copyright[^\n]+\n+" "" license "${license}")
string(STRIP "${license}" license)
string(REGEX REPLACE "\n\n" "\n.\n" license "${license}")
string(REPLACE "\n" "\n " DM_LICENSE " ${license}")
configure_file(cmake/copyright.in ${debian}/copyright @ONLY)

string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
file(WRITE ${debian}/changelog.Debian "dreampm (${PROJECT_VERSION}-1) unstable; urgency=medium

  * Version ${PROJECT_VERSION}; changelog.gz says what is new.

 -- ${CPACK_PACKAGE_CONTACT}  ${date}
")
configure_file(CHANGELOG.md ${debian}/changelog COPYONLY)
foreach(file changelog changelog.Debian)
  execute_process(COMMAND gzip -9nf ${debian}/${file} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
file(WRITE ${debian}/overrides "# One package holds the command, the library and its headers.
dreampm: package-name-doesnt-match-sonames
dreampm: link-to-shared-library-in-wrong-package
# CPack writes these scripts beside the trigger.
dreampm: maintscript-calls-ldconfig
# It is no upload to Debian.
dreampm: initial-upload-closes-no-bugs
")
install(FILES ${debian}/copyright ${debian}/changelog.gz ${debian}/changelog.Debian.gz DESTINATION ${CMAKE_INSTALL_DOCDIR}
        COMPONENT runtime)
install(FILES ${debian}/overrides RENAME dreampm DESTINATION ${CMAKE_INSTALL_DATADIR}/lintian/overrides COMPONENT runtime)
