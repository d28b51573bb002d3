# Turns files into strings of the binary, name (below `root`) and text: writes the source `output`, which defines the
# function `function` that `header` declares. The further arguments are patterns of the files, below `root`.
function(pointgi_embed output header function root)
  list(TRANSFORM ARGN PREPEND ${root}/ OUTPUT_VARIABLE patterns)
  file(GLOB_RECURSE files CONFIGURE_DEPENDS ${patterns})
  list(SORT files)
  add_custom_command(
    OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -D OUTPUT=${output} -D HEADER=${header} -D FUNCTION=${function} -D ROOT=${root}
            -D "FILES=${files}" -P ${CMAKE_SOURCE_DIR}/scripts/cmake/write_embedded_files.cmake
    DEPENDS ${files} ${CMAKE_SOURCE_DIR}/scripts/cmake/write_embedded_files.cmake
    COMMENT "Embedding the files of ${function}()"
    VERBATIM)
endfunction()
