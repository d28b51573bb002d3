#ifndef POINTGI_SHARED_PAIR_TYPES_H
#define POINTGI_SHARED_PAIR_TYPES_H
#include "shared/fmm_types.h"
/* Who sees whom of points, and launches that ask: of all pairs (method.md section 4), and of receivers and senders
 * (section 8). */

/* Senders that are summed apart: n terms of about the same size one by one lose sqrt(n) roundings in float. */
#define SENDERS_SUMMED 256

/* A tile is FMM_LANES x FMM_LANES pairs, a bit each: bit FMM_LANES m + q of the tile (row, column) is set where the
 * points FMM_LANES row + q and FMM_LANES column + m may exchange light and see each other. A square is SQUARE_TILES x
 * SQUARE_TILES tiles, row after row. Squares on and below the diagonal are kept, row after row: a bit an unordered
 * pair, but in squares on the diagonal, which are whole. Tiles above the diagonal are the mirror images of those below:
 * reading a column of a square touches two pages of memory. */
#define SQUARE_TILES (SENDERS_SUMMED / FMM_LANES)
#define SQUARE_AT(row, column) ((pg_ulong)(row) * ((pg_ulong)(row) + 1) / 2 + (column))
#define PAIR_TILE(row, column)                                                                                         \
  ((pg_ulong)(SQUARE_TILES * SQUARE_TILES) * SQUARE_AT((row) / SQUARE_TILES, (column) / SQUARE_TILES) +                \
   SQUARE_TILES * ((row) % SQUARE_TILES) + (column) % SQUARE_TILES)
/* Tiles of the first so many rows of squares. */
#define PAIR_TILES(square_rows) ((pg_ulong)(SQUARE_TILES * SQUARE_TILES) * SQUARE_AT(square_rows, 0))

/* A launch over rows of tiles, of which a buffer holds a band: whole rows. */
typedef struct PairRows {
  pg_uint held_from;    /* bytes 0-3: first row of the band, that of a square */
  pg_uint held_end;     /* bytes 4-7: row behind its last */
  pg_uint first_row;    /* bytes 8-11: of the launch */
  pg_uint rows;         /* bytes 12-15 */
  pg_uint first_column; /* bytes 16-19: of a launch that traces */
  pg_uint columns;      /* bytes 20-23 */
  pg_uint points;       /* bytes 24-27 */
  pg_uint stride;       /* bytes 28-31: of planes */
  float step_delta;     /* bytes 32-35: root cube */
} PairRows;

/* A launch over rows of FMM_LANES receivers. Byte s of a row has bit q set where the receiver q of the row may exchange
 * light with its sender s and sees it; a buffer holds whole rows. */
typedef struct SenderRows {
  pg_uint held_from;     /* bytes 0-3: first row of the buffer */
  pg_uint first_row;     /* bytes 4-7: of the launch */
  pg_uint rows;          /* bytes 8-11 */
  pg_uint receivers;     /* bytes 12-15 */
  pg_uint senders;       /* bytes 16-19: of each receiver, bytes of a row */
  pg_uint stride;        /* bytes 20-23: of the receivers' planes */
  pg_uint sender_stride; /* bytes 24-27: of the senders' */
  pg_uint pass;          /* bytes 28-31: of senders that are picked anew in each, as is the seed */
  pg_uint seed;          /* bytes 32-35 */
  float step_delta;      /* bytes 36-39: root cube */
} SenderRows;

#endif
