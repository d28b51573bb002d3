/* The traversal interface: trace_closest, trace_any, trace_blended, on the form of the octree that was chosen. */
#include "lib/step_traversal.cl"
