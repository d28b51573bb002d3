/* Where is kept what points meet in their directions. */
#include "shared/fmm_types.h"
#include "shared/traversal_types.h"

/* Hits are kept in blocks of FMM_LANES points: word FMM_LANES (block * count + k) + lane is that of direction k. */
#define HIT_AT(i, k, count) (FMM_LANES * ((ulong)((i) / FMM_LANES) * (count) + (k)) + (i) % FMM_LANES)
