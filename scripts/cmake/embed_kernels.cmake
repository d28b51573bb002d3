# Turns every file of kernels/ into a string of the binary: name (below kernels/) and text, as host/cl/kernel_source reads.
function(pointgi_embed_kernels output)
  file(GLOB_RECURSE kernel_files CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/kernels/*.cl ${CMAKE_SOURCE_DIR}/kernels/*.h
       ${CMAKE_SOURCE_DIR}/kernels/*.toml)
  list(SORT kernel_files)
  add_custom_command(
    OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -D OUTPUT=${output} -D ROOT=${CMAKE_SOURCE_DIR}/kernels -D "FILES=${kernel_files}"
            -P ${CMAKE_SOURCE_DIR}/scripts/cmake/write_embedded_kernels.cmake
    DEPENDS ${kernel_files} ${CMAKE_SOURCE_DIR}/scripts/cmake/write_embedded_kernels.cmake
    COMMENT "Embedding the kernels"
    VERBATIM)
endfunction()
