/* What the shape of a robot's questions depends on, from what it says of itself. */
#include <string.h>

#include "json_reader.h"
#include "json_writer.h"

/* Counts the names sections[k].... by k, and legs[i].link.sections[k].... by both, which stand in this order. */
static void count_by_section(const json_node* list, robot_facts* facts, size_t* sizes) {
  static const char begin[] = "sections[";
  const char* before = "";
  size_t before_size = 0, count = 0;
  for (const json_node* element = list ? list->first : NULL; element; element = element->next) {
    const char* name = json_member_text(element, "name");
    const char* section = strstr(name, begin);
    const char* end = section ? strchr(section, ']') : NULL;
    if (!end) continue;
    const size_t size = (size_t)(end - name);
    if (count == 0 || size != before_size || strncmp(name, before, size) != 0) ++count;
    if (count > MAX_SECTIONS) return;
    ++sizes[count - 1];
    before = name;
    before_size = size;
  }
  if (count > facts->section_count) facts->section_count = count;
}

void robot_facts_read(robot_facts* facts, const json_node* described) {
  memset(facts, 0, sizeof *facts);
  const json_node* inputs = json_member(described, "inputs");
  const char* kind = json_member_text(described, "kind");
  facts->is_serial = strcmp(kind, "serial") == 0;
  facts->is_of_arms = strcmp(kind, "arm") == 0 || strcmp(kind, "arm_legs") == 0;
  facts->input_count = inputs ? inputs->size : 0;
  if (!facts->is_serial && !facts->is_of_arms) return;
  count_by_section(inputs, facts, facts->change_sizes);
  count_by_section(json_member(described, "configuration"), facts, facts->configuration_sizes);
}
