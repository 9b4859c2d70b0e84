/* What the shape of a robot's questions depends on, from what it says of itself. */
#include <stdlib.h>
#include <string.h>

#include "json_reader.h"
#include "json_writer.h"

/* Counts the names sections[k].... by k. */
static void count_by_section(const json_node* list, robot_facts* facts, size_t* sizes) {
  static const char begin[] = "sections[";
  for (const json_node* element = list ? list->first : NULL; element; element = element->next) {
    const char* name = json_member_text(element, "name");
    if (strncmp(name, begin, strlen(begin)) != 0) continue;
    const size_t section = strtoul(name + strlen(begin), NULL, 10);
    if (section >= MAX_SECTIONS) continue;
    ++sizes[section];
    if (section >= facts->section_count) facts->section_count = section + 1;
  }
}

void robot_facts_read(robot_facts* facts, const json_node* described) {
  memset(facts, 0, sizeof *facts);
  const json_node* inputs = json_member(described, "inputs");
  facts->is_serial = strcmp(json_member_text(described, "kind"), "serial") == 0;
  facts->input_count = inputs ? inputs->size : 0;
  if (!facts->is_serial) return;
  count_by_section(inputs, facts, facts->change_sizes);
  count_by_section(json_member(described, "configuration"), facts, facts->configuration_sizes);
}
