#ifndef POINTGI_SHARED_SCALAR_H
#define POINTGI_SHARED_SCALAR_H
/* Scalars of the structs that host and device share. Every file of this folder is valid C++17 and valid OpenCL C 1.2;
 * structs hold 4-byte scalars only (pg_ulong is for indices), so that both sides agree on offsets without attributes.
 */
#ifdef __OPENCL_VERSION__
typedef uint pg_uint;
typedef ulong pg_ulong;
#else
#include <cstdint>
typedef std::uint32_t pg_uint;
typedef std::uint64_t pg_ulong;
#endif
#endif
