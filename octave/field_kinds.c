#include "field_kinds.h"

#include <string.h>

static bool is_one_of(const char* name, const char* const* names) {
  for (; *names; ++names)
    if (strcmp(name, *names) == 0) return true;
  return false;
}

enum field_kind field_kind(const char* query, bool is_serial, bool is_of_arms, const char* name) {
  static const char* const numbers[] = {"x", "y", "phi", "z", "e1", "e2", "tilt", "azimuth", "torsion", NULL};
  static const char* const vectors[] = {
      "inputs",    "wrench",     "gravity", "twist", "along",     "rates",        "position",
      "direction", "quaternion", "bending", "elbow", "curvature", "axial_forces", "measured_tensions",
      NULL};
  static const char* const lists[] = {"want", "with_respect_to", "slack", "poses", "loads", "times", NULL};
  static const char* const measured_lists[] = {"time", "blocks", NULL};
  static const char* const measured_rows[] = {"pulls", "markers", NULL};
  static const char* const robot_lists[] = {"legs", "actuated", NULL};
  static const char* const rows[] = {"tensions", "lengths", "angles", NULL};
  if (strcmp(query, "robot") == 0) return is_one_of(name, robot_lists) ? FIELD_LIST : FIELD_PLAIN;
  if (strcmp(query, "identify") == 0) {
    if (is_one_of(name, measured_lists)) return FIELD_LIST;
    if (is_one_of(name, measured_rows)) return FIELD_ROWS;
  }
  if (is_one_of(name, numbers)) return FIELD_NUMBER;
  if (is_one_of(name, vectors)) return FIELD_VECTOR;
  if (is_one_of(name, lists)) return FIELD_LIST;
  if (strcmp(name, "start") == 0) return is_serial ? FIELD_SECTIONS : FIELD_VECTOR;
  if (is_serial && strcmp(name, "changes") == 0 && strcmp(query, "diagram") == 0) return FIELD_PLAIN;
  if (is_serial && (strcmp(name, "configuration") == 0 || strcmp(name, "changes") == 0))
    return FIELD_SECTIONS;
  if (is_of_arms && (strcmp(name, "tensions") == 0 || strcmp(name, "changes") == 0)) return FIELD_SECTIONS;
  return !is_serial && is_one_of(name, rows) ? FIELD_ROWS : FIELD_PLAIN;
}

bool field_takes_null(const char* name) {
  static const char* const names[] = {"lengths", "measured_tensions", "tensions", "changes", "displacements", NULL};
  return is_one_of(name, names);
}
