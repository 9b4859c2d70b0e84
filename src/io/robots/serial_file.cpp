#include "io/robots/serial_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "base/limits.hpp"
#include "io/document/parse.hpp"
#include "io/document/quantity.hpp"
#include "io/document/reader.hpp"
#include "io/robots/actuation.hpp"
#include "io/robots/arm_file.hpp"
#include "io/robots/robot_size.hpp"
#include "sinew/io/robot_file.hpp"

namespace sinew::inline v1 {
namespace {

constexpr int max_segments = 1000, max_tendons = 24;

/// Angles of tendon 0 of every section [rad]: a list, or `24 deg each`, by which every section is turned
/// against the one before (the first against the x axis).
std::vector<double> section_angles(const Reader& angle, std::size_t count) {
  if (angle.is(Node::Kind::list)) return angle.quantities(Dimension::angle, Range::turn(), count);
  std::vector<double> angles(count, 0.0);
  const std::string text = angle.node() ? angle.node()->text : std::string();
  constexpr std::string_view each = " each";
  const auto turn = text.ends_with(each)
                        ? parse_quantity(text.substr(0, text.size() - each.size()), Dimension::angle)
                        : Expected<double>(tl::unexpected(Errors{}));
  if (turn && !Range::turn().contains(*turn)) {
    angle.refuse("out_of_range", "give an angle of at most 1e6 rad");
  } else if (!turn) {
    angle.refuse(
        "wrong_type",
        fmt::format(
            "write how much every section is turned against the one before, \"24 deg each\", or a list "
            "of {} angles",
            count));
  } else {
    for (std::size_t m = 0; m < count; ++m) angles[m] = static_cast<double>(m + 1) * *turn;
  }
  return angles;
}

/// One section of the list that a short form stands for.
Node section_node(const Node& shared, double angle) {
  Node section = shared;
  std::erase_if(section.members, [](const Member& member) { return member.key == "count"; });
  if (Node* tendons = section.find("tendons"))
    if (Node* place = tendons->find("angle")) *place = placed(make_node(angle), *place);
  return section;
}

void read_disc(Reader& section, Section& result) {
  auto disc = section.optional("disc");
  if (!disc) return;
  result.disc_height =
      disc->required("height").quantity(Dimension::length, {.low = 0, .high = Range::size().high});
  result.disc_radius = disc->required("radius").quantity(Dimension::length, Range::size());
  disc->close();
}

void read_tendons(Reader& section, Section& result) {
  Reader tendons = section.required("tendons", "{count, radius, angle}");
  if (const auto count = tendons.optional("count"))
    result.tendons = count->integer(Range::between(3, max_tendons));
  const Reader radius = tendons.required("radius", "distance of the tendons from the backbone");
  result.tendon_radius = radius.quantity(Dimension::length, Range::size());
  if (result.disc_radius > 0 && radius.node() && result.tendon_radius > result.disc_radius)
    radius.refuse("out_of_range", fmt::format("the disc's radius is {}: the tendons would run outside it",
                                              human(result.disc_radius, Dimension::length)));
  const Range each = Range::turn();  // from one section to the next
  result.tendon_angle =
      tendons.required("angle", "direction of tendon 0 around the disc")
          .quantity(Dimension::angle, Range::between(max_sections * each.low, max_sections * each.high));
  tendons.close();
}

void read_limit(Reader& section, Section& result) {
  const auto limit = section.optional("limit");
  if (!limit) return;
  const double most = std::numbers::pi * (result.is_twin() ? 1 : result.segments);
  result.limit = limit->quantity(Dimension::angle, {.low = 0, .high = most, .low_excluded = true});
}

void read_extension(Reader& section, Section& result) {
  const auto extension = section.optional("extension");
  if (!extension) return;
  const auto items = extension->items(2);
  if (items.size() != 2) return;
  const double least = items[0].quantity(Dimension::length, {.low = -Range::place().high, .high = 0}),
               most = items[1].quantity(Dimension::length, {.low = 0, .high = Range::place().high});
  if (result.is_twin())
    extension->fail("no_effect", "twin pivots have no length to vary; write it of a neutral backbone");
  else if (least == 0 && most == 0)
    extension->fail("out_of_range", "both are 0: remove it, or write how far the section can get longer");
  else if (!(least > -result.arc_length()))
    items[0].fail("longer_than_section",
                  fmt::format("the backbone is {} long: it cannot get shorter than that",
                              human(result.arc_length(), Dimension::length)));
  result.min_extension = least;
  result.max_extension = most;
}

Section read_section(Reader& section) {
  Section result;
  const std::string type =
      section.required("type", "tpcj, neutral or elastic").choice({"tpcj", "neutral", "elastic"});
  result.backbone = type == "tpcj" ? kernel::Backbone::twin_pivot : kernel::Backbone::neutral;
  const Reader segments = section.required("segments", "how many joints, each with a disc");
  result.segments = segments.integer(Range::between(1, max_segments));
  if (segments.node() && result.is_twin() && result.segments % 2 == 1)
    segments.refuse("out_of_range", "twin-pivot joints bend about two axes in turn: give an even number");
  result.joint = section.required("joint", "length of the backbone in one joint")
                     .quantity(Dimension::length, Range::size());
  read_disc(section, result);
  read_tendons(section, result);
  read_limit(section, result);
  read_extension(section, result);
  section.close();
  return result;
}

void read_actuation(Reader& robot, SerialRobot& result) {
  if (auto motor = robot.optional("motor")) result.motor = read_motor(*motor);
  if (auto stretch = robot.optional("stretch")) result.stretch = read_stretch(*stretch);
}

SerialRobot read_serial(Reader& robot) {
  SerialRobot result;
  const Reader version = robot.required("sinew", "version of the file format: 1");
  if (version.integer() != 1 && version.node())
    version.refuse("unknown_version", "this sinew reads version 1");
  robot.required("kind");
  result.name = robot.required("name").text();
  if (const auto geometry = robot.optional("geometry"))
    result.geometry_inferred = geometry->choice({"given", "inferred"}) == "inferred";
  const auto tolerance = robot.optional("tolerance");
  if (tolerance)
    result.tolerance = tolerance->quantity(Dimension::length, {.low = 0, .high = Range::size().high});
  Reader sections = robot.required("sections", "a list, one entry a section, or {count, ...}");
  if (sections.node()) {
    auto items = sections.items();
    if (items.empty()) sections.fail("too_few_sections", "there is none; list at least one section.");
    if (items.size() > max_sections) {
      sections.fail("too_many_sections", fmt::format("there are {} sections; this build carries at most {}.",
                                                     items.size(), max_sections));
      items.clear();
    }
    for (Reader& section : items) result.sections.push_back(read_section(section));
  }
  read_actuation(robot, result);
  if (!tolerance) result.tolerance = usual_tolerance(result.length(), result.motor);
  robot.close();
  return result;
}

}  // namespace

bool is_serial(const Document& document) {
  const Node* kind = document.root.find("kind");
  return kind && kind->text == "serial";
}

Expected<Document> expanded_sections(const Document& document) {
  const Node* sections = document.root.find("sections");
  if (!sections || sections->kind != Node::Kind::map) return document;
  Errors errors;
  Reader robot(document, errors);
  Reader shared = robot.required("sections");
  const auto count = static_cast<std::size_t>(
      shared.required("count", "how many sections there are").integer(Range::between(1, max_sections)));
  std::vector<double> angles(count, 0.0);
  if (auto tendons = shared.optional("tendons"); tendons && !tendons->is(Node::Kind::list))
    if (const auto angle = tendons->optional("angle")) angles = section_angles(*angle, count);
  if (!errors.empty()) return tl::unexpected(errors);
  Document longer = document;
  Node list = placed(Node(), *sections);
  list.kind = Node::Kind::list;
  for (const double angle : angles) list.items.push_back(section_node(*sections, angle));
  *longer.root.find("sections") = std::move(list);
  return longer;
}

Expected<SerialRobot> read_serial_robot(const Document& document) {
  if (is_arm(document))
    return failure(
        "wrong_kind", document.source,
        "its sections are elastic, and their shape depends on loads; give a robot with sections of "
        "type tpcj or neutral.");
  if (auto fits = check_size(document); !fits) return tl::unexpected(fits.error());
  const Expected<Document> longer = expanded_sections(document);
  if (!longer) return tl::unexpected(longer.error());
  Errors errors;
  Reader robot(*longer, errors);
  SerialRobot result = read_serial(robot);
  if (!errors.empty()) return tl::unexpected(errors);
  return result;
}

Expected<SerialRobot> load_serial(const std::string& path_or_name) {
  const Expected<Document> document = read_robot_file(path_or_name);
  if (!document) return tl::unexpected(document.error());
  if (is_serial(*document)) return read_serial_robot(*document);
  Errors errors;
  Reader robot(*document, errors);
  robot.fail("wrong_kind", "is no serial robot; load reads it");
  return tl::unexpected(errors);
}

Expected<TendonMotor> read_motor(const Document& document) {
  Errors errors;
  Reader motor(document, errors);
  const TendonMotor read = sinew::read_motor(motor);
  return errors.empty() ? Expected<TendonMotor>(read) : tl::unexpected(errors);
}

}  // namespace sinew::inline v1
