# The viewer's page: built from web/ by npm, and put into the program as it is. page_source is the file to compile.
find_program(NODE node REQUIRED)
find_program(NPM npm REQUIRED)
mark_as_advanced(NODE NPM)
set(web ${PROJECT_SOURCE_DIR}/web)
set(page ${CMAKE_CURRENT_BINARY_DIR}/page)
set(page_source ${CMAKE_CURRENT_BINARY_DIR}/page.cpp)

# Libraries of the page, as the lock file has them. Builds share them, so the stamp is theirs.
set(installed ${web}/node_modules/.package-lock.json)
add_custom_command(OUTPUT ${installed}
  COMMAND ${NPM} ci --prefix ${web} --no-audit --no-fund --silent
  DEPENDS ${web}/package.json ${web}/package-lock.json WORKING_DIRECTORY ${web} COMMENT "Installing the page's libraries" VERBATIM)

file(GLOB page_inputs CONFIGURE_DEPENDS ${web}/src/*.ts ${web}/src/*.css ${web}/src/*/*.ts ${web}/src/*/*.css ${web}/index.html ${web}/build.mjs ${web}/tsconfig.json)
set(page_files "")
foreach(name index.html app.js editor.js app.css)
  list(APPEND page_files ${page}/${name} ${page}/${name}.gz)
endforeach()
add_custom_command(OUTPUT ${page_files}
  COMMAND ${NODE} ${web}/node_modules/typescript/bin/tsc --noEmit -p ${web}
  COMMAND ${NODE} ${web}/build.mjs ${page}
  DEPENDS ${installed} ${page_inputs} COMMENT "Building the page" VERBATIM)

# .incbin takes no time; an array of bytes would take seconds to compile.
set(bytes "")
set(rows "")
set(declared "")
foreach(row "index.html /@text/html; charset=utf-8" "app.js /app.js@text/javascript; charset=utf-8" "editor.js /editor.js@text/javascript; charset=utf-8" "app.css /app.css@text/css; charset=utf-8")
  string(REGEX MATCH "^([^ ]+) ([^@]+)@(.+)$" found "${row}")
  string(MAKE_C_IDENTIFIER ${CMAKE_MATCH_1} id)
  string(APPEND rows "      Asset{\"${CMAKE_MATCH_2}\", \"${CMAKE_MATCH_3}\", text(page_${id}, page_${id}_end), text(page_${id}_gz, page_${id}_gz_end)},\n")
  foreach(variant "" "_gz")
    string(REPLACE "_gz" ".gz" ending "${variant}")
    string(APPEND bytes "    \"page_${id}${variant}: .incbin \\\"${page}/${CMAKE_MATCH_1}${ending}\\\"\\n\"\n    \"page_${id}${variant}_end: .byte 0\\n\"\n")
    string(APPEND declared "extern const char page_${id}${variant}[] asm(\"page_${id}${variant}\"), page_${id}${variant}_end[] asm(\"page_${id}${variant}_end\");\n")
  endforeach()
endforeach()
file(CONFIGURE OUTPUT ${page_source} @ONLY CONTENT
[[// Generated: the files of the page.
#include <array>

#include "server/assets.hpp"

asm(".pushsection .rodata\n"
@bytes@    ".popsection\n");

@declared@
namespace sinew::server {

std::span<const Asset> assets() {
  const auto text = [](const char* begin, const char* end) {
    return std::string_view(begin, static_cast<std::size_t>(end - begin));
  };
  static const std::array files{
@rows@  };
  return files;
}

}  // namespace sinew::server
]])
set_source_files_properties(${page_source} PROPERTIES OBJECT_DEPENDS "${page_files}")
