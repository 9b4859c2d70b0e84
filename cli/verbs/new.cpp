/// new: a commented robot file to start from, or a study.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "sinew/io/node.hpp"
#include "sinew/io/robot_file.hpp"
#include "terminal.hpp"
#include "text_table.hpp"
#include "verbs.hpp"

namespace sinew::cli {
namespace {

struct Kind {
  std::string_view name;  ///< as one writes it
  std::string_view file;  ///< of examples/robots, without `.yaml`
  std::string_view summary;
};

constexpr std::array kinds{
    Kind{"3-RFR", "3-rfr", "planar, short form: links between free joints, 3 inputs"},
    Kind{"3-FRR", "3-frr", "planar, short form: clamped links with struts, 3 inputs"},
    Kind{"3-RFRR", "3-rfrr", "planar, short form, redundant: links on motors with struts, 6 inputs"},
    Kind{"6-UFS", "6-ufs", "spatial, short form: six links between free joints, 6 inputs"},
    Kind{"3-PRS", "3prs", "spatial, short form, rigid: carriages on rails, struts on hinges, 3 inputs"},
    Kind{"3PFS", "3pfs", "spatial, legs listed, elastic: three pairs of rods that bear load, 3 inputs"},
    Kind{"6PFS", "6pfs", "spatial, legs listed, elastic: six rods on three ball joints, 6 inputs"},
    Kind{"hexapod", "hexapod", "spatial, legs listed, elastic: six rods clamped at the platform, 6 inputs"},
    Kind{"2PRS-1PFS", "2prs-1pfs", "spatial, legs listed: a pair of elastic rods beside struts, 3 inputs"},
    Kind{"planar", "mixed-legs", "planar, legs listed: a chord, a strut, and a strut on a motor, 4 inputs"},
    Kind{"two-legged", "two-legged",
         "planar, legs listed, fully determined: a pinned link on a motor and a chord"},
    Kind{"four-legged", "four-legged", "planar, legs listed, redundantly constrained: four chords"},
    Kind{"spatial", "spatial", "spatial, legs listed: six links in pairs from three shared base points"},
    Kind{"serial", "serial", "serial: sections one after the other, bent by tendons, 3 or more inputs each"},
    Kind{"three-arcs", "three-arcs", "serial: three smooth arcs, 3 tendons each"},
    Kind{"extensible", "extensible", "serial: sections that bend and change their length"},
    Kind{"snake", "snake", "serial: alike sections of twin pivots, in one line"},
    Kind{"arm", "arm", "serial, elastic: sections that bear loads, tendons of all routes, 7 inputs"},
};

/// No robots, but files to start from as well.
constexpr std::string_view study = "study", scene = "scene";

/// `3-rfr` is `3-RFR`.
bool is_same(std::string_view a, std::string_view b) {
  return std::ranges::equal(
      a, b, {}, [](unsigned char c) { return std::tolower(c); },
      [](unsigned char c) { return std::tolower(c); });
}

std::string list() {
  TextTable table({"kind", "what it is"});
  for (const Kind& kind : kinds) table.add({std::string(kind.name), std::string(kind.summary)});
  table.add({std::string(study), "of a robot: what sinew sweep runs"});
  table.add({std::string(scene), "of a serial robot: what it goes in through, for sinew plan"});
  return table.text();
}

int refuse_kind(const std::string& word) {
  const auto names = kind_names();
  const std::string_view hint = closest(word, names);
  return refuse("new", {{"unknown_choice", in_quotes(word),
                         fmt::format("no such kind{} There are: {}.",
                                     hint.empty() ? "." : fmt::format("; did you mean {}?", hint),
                                     fmt::join(names, ", "))}});
}

}  // namespace

std::vector<std::string_view> kind_names() {
  std::vector<std::string_view> names;
  for (const Kind& kind : kinds) names.push_back(kind.name);
  names.push_back(study);
  names.push_back(scene);
  return names;
}

int run_new(const Arguments& arguments) {
  if (arguments.operands.empty()) {  // nothing to print into a file: the kinds are a message
    message("sinew new: which kind? For example: sinew new 3-RFR > mine.yaml [missing_kind]\n\n" + list());
    return bad_input;
  }
  const std::string word = arguments.operand();
  if (word == study) return new_study(arguments);
  if (word == scene) {
    print(scene_template());
    return solved;
  }
  const auto kind = std::ranges::find_if(kinds, [&](const Kind& row) { return is_same(row.name, word); });
  if (kind == kinds.end()) return refuse_kind(word);
  print(robot_template(kind->file));
  return solved;
}

}  // namespace sinew::cli
