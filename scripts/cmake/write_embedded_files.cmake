# cmake -D OUTPUT=... -D HEADER=... -D FUNCTION=... -D ROOT=... -D FILES=a;b;c -P: the build step of embed_files.cmake.
set(text "#include \"${HEADER}\"\n\nnamespace pointgi {\n\nconst std::vector<EmbeddedFile>& ${FUNCTION}() {\n  static const std::vector<EmbeddedFile> files = {\n")
foreach(file IN LISTS FILES)
  file(RELATIVE_PATH name ${ROOT} ${file})
  file(READ ${file} content)
  string(APPEND text "{\"${name}\", R\"EMBEDDED(${content})EMBEDDED\"},\n")
endforeach()
string(APPEND text "  };\n  return files;\n}\n\n} // namespace pointgi\n")
file(WRITE ${OUTPUT} "${text}")
