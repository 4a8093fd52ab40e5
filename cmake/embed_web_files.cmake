# cmake -DSOURCE=folder -DOUTPUT=file.cpp -P: a C++ file with the contents of the folder as bytes, for web_files.hpp.
file(GLOB names RELATIVE ${SOURCE} ${SOURCE}/*)
list(SORT names)
set(types_html "text/html; charset=utf-8")
set(types_css "text/css; charset=utf-8")
set(types_js "text/javascript; charset=utf-8")
set(types_svg "image/svg+xml")
set(contents "")
set(rows "")
set(index 0)
foreach(name ${names})
  string(REGEX REPLACE "^.*\\." "" suffix ${name})
  if(NOT DEFINED types_${suffix})
    message(FATAL_ERROR "${SOURCE}/${name}: no content type is known for .${suffix}")
  endif()
  file(READ ${SOURCE}/${name} hex HEX)
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${hex}")
  string(REGEX REPLACE "(................................................................................)" "\\1\n" bytes "${bytes}")
  string(APPEND contents "const unsigned char bytes_${index}[] = {${bytes}0};\n")
  string(APPEND rows "    {\"${name}\", \"${types_${suffix}}\", {reinterpret_cast<const char*>(bytes_${index}), sizeof bytes_${index} - 1}},\n")
  math(EXPR index "${index} + 1")
endforeach()
file(WRITE ${OUTPUT} "// Made by cmake/embed_web_files.cmake.
#include \"view/web_files.hpp\"

namespace sunfleck {

namespace {
${contents}
const WebFile files[] = {
${rows}};
}  // namespace

const WebFile* web_file(std::string_view name) {
  for (const auto& file : files)
    if (file.name == name) return &file;
  return nullptr;
}

}  // namespace sunfleck
")
