# cmake -D OUTPUT=... -D ROOT=... -D FILES=a;b;c -P: the build step of embed_kernels.cmake.
set(text "#include \"host/cl/embedded_kernels.h\"\n\nnamespace pointgi {\n\nconst std::vector<EmbeddedFile>& embedded_kernels() {\n  static const std::vector<EmbeddedFile> files = {\n")
foreach(file IN LISTS FILES)
  file(RELATIVE_PATH name ${ROOT} ${file})
  file(READ ${file} content)
  string(APPEND text "{\"${name}\", R\"KERNEL(${content})KERNEL\"},\n")
endforeach()
string(APPEND text "  };\n  return files;\n}\n\n} // namespace pointgi\n")
file(WRITE ${OUTPUT} "${text}")
