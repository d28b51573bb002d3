/* Vectors of eight, for devices whose work-items have vector registers of their own: CPU compilers do not vectorise
 * diverging work-items. */

/* min and max, not fmin and fmax, which pay for NaN: what is compared is never NaN. */
static inline float smallest8(float8 v) {
  const float4 a = min(v.lo, v.hi);
  return min(min(a.x, a.y), min(a.z, a.w));
}

/* any() is compiled to a branch a lane by some. Byte k is 1 where lane k of a comparison is true. */
static inline ulong byte_a_lane(int8 comparison) {
  return as_ulong(convert_char8(comparison)) & 0x0101010101010101ul;
}

/* Index of the lowest byte that is not zero. */
static inline uint lowest_byte(ulong bytes) { return (uint)popcount((bytes & (0ul - bytes)) - 1ul) >> 3; }
