/* Which pixel and sample a work-item has: by its linear number in the group, so that no bit of the picture depends on the
 * group's shape.
 *   GROUP_X, GROUP_Y  shape of a work-group, 32 or 64 work-items: one or two pixels side by side */
#ifndef GROUP_X
#define GROUP_X 8
#endif
#ifndef GROUP_Y
#define GROUP_Y 4
#endif
#include "shared/render_types.h"

#define GROUP_PIXELS (GROUP_X * GROUP_Y / GRID_RAYS)

typedef struct GroupItem {
  uint column, row; /* of the tile; beyond it in groups that stick out */
  uint pixel;       /* of the group */
  uint lane;        /* of the pixel's 32 rays */
} GroupItem;

static inline GroupItem group_item(void) {
  const uint number = get_local_id(1) * GROUP_X + get_local_id(0);
  GroupItem item;
  item.pixel = number / GRID_RAYS;
  item.lane = number % GRID_RAYS;
  item.column = GROUP_PIXELS * get_group_id(0) + item.pixel;
  item.row = get_group_id(1);
  return item;
}
