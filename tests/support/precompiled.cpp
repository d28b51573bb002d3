// Compiled with the header that test programs share: CMake makes that header for a target that has a source to use it.
