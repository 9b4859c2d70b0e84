#include "io/robots/arm_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/limits.hpp"
#include "io/document/quantity.hpp"
#include "io/document/reader.hpp"
#include "io/measured/measurement.hpp"
#include "io/robots/actuation.hpp"
#include "io/robots/arm_backbone.hpp"
#include "io/robots/arm_legs_file.hpp"
#include "io/robots/read_pose.hpp"
#include "io/robots/robot_size.hpp"
#include "io/robots/serial_file.hpp"

namespace sinew::inline v1 {
namespace {

constexpr std::string_view elastic = "elastic";
constexpr int max_discs = 1000;
constexpr double max_compliance = 1e9;       // [m/N]
constexpr std::size_t max_arm_tendons = 24;  // all of them pass the first section

std::string_view type_of(const Node& section) {
  const Node* type = section.find("type");
  return type ? std::string_view(type->text) : std::string_view();
}

/// Length of a tendon through a section that is straight: from disc to disc, or along its channel.
double straight_length(const TendonRoute& route, const ArmSection& section) {
  if (route.start_radius == route.end_radius && route.start_angle == route.end_angle) return section.length;
  const int steps = section.discs.count > 0 ? section.discs.count : 1000;
  const double turn = (route.end_angle - route.start_angle) / steps;
  double sum = 0;
  for (int k = 0; k < steps; ++k) {
    const auto radius = [&](int i) {
      return route.start_radius + (route.end_radius - route.start_radius) * i / steps;
    };
    const double a = radius(k), b = radius(k + 1), half = std::sin(turn / 2),
                 across = (b - a) * (b - a) + 4 * a * b * half * half;
    sum += std::sqrt(section.length / steps * section.length / steps + across);
  }
  return sum;
}

/// Reads a document whose sections are listed.
class ArmReader {
 public:
  ArmReader(Reader& robot, const Errors& errors) : robot_(robot), errors_(errors) {}

  Arm read() {
    read_head();
    Reader sections = robot_.required("sections", "a list, one entry a section, or {count, ...}");
    if (sections.node()) read_sections(sections);
    if (auto measurement = robot_.optional("measurement"); measurement && errors_.empty())
      arm_.measurement = read_measurement(*measurement, arm_);  // asks how many tendons there are
    if (!has_tolerance_) arm_.tolerance = usual_tolerance(arm_.length(), arm_.motor);
    robot_.close();
    return std::move(arm_);
  }

  /// Of a leg: what a link says of it.
  Arm read_sections_alone() {
    if (auto stretch = robot_.optional("stretch")) stretch_ = read_stretch(*stretch);
    const Reader sections = robot_.required("sections", "a list, one entry a section, or {count, ...}");
    if (sections.node()) read_sections(sections);
    return std::move(arm_);
  }

 private:
  void read_head();
  void read_tip(Reader& tip);
  void read_sections(const Reader& sections);
  void read_section(Reader& section);
  void read_guides(Reader& section);
  void read_tendons(Reader& section);
  void read_tendon(Reader& tendon, int count);
  TendonRoute read_route(Reader& map, std::size_t section, const TendonRoute& usual);
  void read_routes_before(Reader& tendon, const TendonRoute& own, std::vector<TendonRoute>& routes);
  void check_radius(const Reader& place, double radius, std::size_t section) const;
  void read_properties(Reader& map, ArmTendon& tendon);

  Reader& robot_;
  const Errors& errors_;
  Arm arm_;
  bool has_tolerance_ = false;
  std::optional<TendonStretch> stretch_;  // of tendons that say nothing else
};

void ArmReader::read_head() {
  const Reader version = robot_.required("sinew", "version of the file format: 1");
  if (version.integer() != 1 && version.node())
    version.refuse("unknown_version", "this sinew reads version 1");
  robot_.required("kind");
  arm_.name = robot_.required("name").text();
  if (const auto geometry = robot_.optional("geometry"))
    arm_.geometry_inferred = geometry->choice({"given", "inferred"}) == "inferred";
  if (const auto gravity = robot_.optional("gravity")) {
    const Vec3<double> g = read_gravity(*gravity);
    arm_.gravity = {g.x(), g.y(), g.z()};
  }
  if (auto tip = robot_.optional("tip")) read_tip(*tip);
  if (const auto tolerance = robot_.optional("tolerance")) {
    arm_.tolerance = tolerance->quantity(Dimension::length, {.low = 0, .high = Range::size().high});
    has_tolerance_ = true;
  }
  if (auto motor = robot_.optional("motor")) arm_.motor = read_motor(*motor);
  if (auto stretch = robot_.optional("stretch")) stretch_ = read_stretch(*stretch);
}

void ArmReader::read_tip(Reader& tip) {
  arm_.tip_mass =
      tip.required("mass", "of what the arm carries").quantity(Dimension::mass, Range::between(0, 1e9));
  if (const auto place = tip.optional("place"))
    arm_.tip_mass_place = place->array<3>(Dimension::length, Range::place());
  tip.close();
}

void ArmReader::read_sections(const Reader& sections) {
  auto items = sections.items();
  if (items.size() > max_sections) {
    sections.fail("too_many_sections", fmt::format("there are {} sections; this build carries at most {}.",
                                                   items.size(), max_sections));
    return;
  }
  for (Reader& section : items) read_section(section);
  if (arm_.tendons.size() > max_arm_tendons)
    sections.fail("too_many_tendons",
                  fmt::format("{} tendons pass the first section; this build carries at most {}.",
                              arm_.tendons.size(), max_arm_tendons));
  const bool has_tendons = std::ranges::any_of(
      items, [](Reader& section) { return section.is(Node::Kind::map) && section.has("tendons"); });
  if (!has_tendons)
    sections.fail("no_tendon",
                  "none has tendons, and nothing drives the arm; give one of them tendons: {count, radius, "
                  "angle}");
}

void ArmReader::read_section(Reader& section) {
  ArmSection& result = arm_.sections.emplace_back();
  result.length = 1;  // after an error
  if (!section.is(Node::Kind::map)) return section.refuse("wrong_type", "give a map of what a section has.");
  const Reader type = section.required("type", "elastic");
  if (type.node() && type_of(*section.node()) != elastic) {
    if (const auto word = type.choice({elastic, "tpcj", "neutral"}); word != elastic)
      type.refuse("mixed_sections",
                  "another section is elastic, and loads shape all of an arm; make every section elastic, or "
                  "none");
    return;
  }
  result.length =
      section.required("length", "of the backbone at rest").quantity(Dimension::length, Range::size());
  Reader backbone = section.required("backbone", "{diameter, material: {E, poisson}}");
  read_backbone_into(result, backbone);
  if (const auto bent = section.optional("precurvature"))
    result.curvature = bent->array<3>(Dimension::curvature, Range::between(-1e6, 1e6));
  read_guides(section);
  read_tendons(section);
  if (const auto limit = section.optional("limit"))
    result.limit =
        limit->quantity(Dimension::angle,
                        {.low = 0, .high = std::numbers::pi * arc_count(result.discs), .low_excluded = true});
  section.close();
}

void ArmReader::read_guides(Reader& section) {
  auto discs = section.optional("discs");
  const auto guides = section.optional("guides");
  if (guides) guides->choice({"channel"});
  if (guides && discs) guides->refuse("ambiguous", "discs and a channel both guide the tendons; keep one");
  if (!guides && !discs)
    section.fail("missing_key", "say what guides the tendons: discs: {count: 10}, or guides: channel");
  if (!discs) return;
  Discs& result = arm_.sections.back().discs;
  result.count = discs->required("count", "how many, the last one at the section's end")
                     .integer(Range::between(1, max_discs));
  if (const auto mass = discs->optional("mass"))
    result.mass = mass->quantity(Dimension::mass, Range::between(0, 1e9));
  if (const auto radius = discs->optional("radius"))
    result.radius = radius->quantity(Dimension::length, Range::size());
  discs->close();
}

void ArmReader::read_tendons(Reader& section) {
  auto tendons = section.optional("tendons");
  if (!tendons) return;
  if (!tendons->is(Node::Kind::list)) {
    int count = 3;
    if (const auto given = tendons->optional("count"))
      count = given->integer(Range::between(1, max_arm_tendons));
    return read_tendon(*tendons, count);
  }
  auto items = tendons->items();
  if (items.empty())
    tendons->fail("no_tendon", "the list is empty; list tendons, or leave it out of a section that has none");
  if (items.size() > max_arm_tendons)  // told of all sections
    items.erase(items.begin() + max_arm_tendons + 1, items.end());
  for (Reader& tendon : items) read_tendon(tendon, 1);
}

/// One of a list, or the first of some evenly around the backbone.
void ArmReader::read_tendon(Reader& tendon, int count) {
  if (!tendon.is(Node::Kind::map))
    return tendon.refuse("wrong_type", "give a map: {radius, angle}, with count of tendons evenly spread.");
  const std::size_t errors_before = errors_.size();
  ArmTendon first;
  const TendonRoute own = read_route(tendon, arm_.sections.size() - 1, {});
  read_routes_before(tendon, own, first.routes);
  if (errors_.size() == errors_before && !tendon.has("through")) {  // parallel through all before
    const Reader radius = tendon.required("radius");
    for (std::size_t m = 0; m + 1 < arm_.sections.size(); ++m) check_radius(radius, own.start_radius, m);
  }
  first.routes.push_back(own);
  read_properties(tendon, first);
  tendon.close();
  for (int k = 0; k < count; ++k) {
    ArmTendon& next = arm_.tendons.emplace_back(first);
    for (TendonRoute& route : next.routes) {
      route.start_angle += 2 * std::numbers::pi * k / count;
      route.end_angle += 2 * std::numbers::pi * k / count;
    }
  }
}

/// @param usual where the angle is not given; of a tendon's own section it must be
TendonRoute ArmReader::read_route(Reader& map, std::size_t section, const TendonRoute& usual) {
  TendonRoute route;
  const auto read_radius = [&](const Reader& place) {
    const std::size_t errors_before = errors_.size();
    const double radius = place.quantity(Dimension::length, Range::size());
    if (place.node() && errors_.size() == errors_before) check_radius(place, radius, section);
    return radius;
  };
  route.start_radius = read_radius(map.required("radius", "distance of the tendon from the backbone"));
  route.end_radius = route.start_radius;
  const bool is_own = usual.start_radius == 0;
  const Range turns = Range::between(-max_sections * Range::turn().high, max_sections * Range::turn().high);
  if (is_own || map.has("angle"))
    route.start_angle =
        map.required("angle", "direction of the tendon from +x").quantity(Dimension::angle, turns);
  else
    route.start_angle = usual.start_angle;
  route.end_angle = route.start_angle;
  if (const auto end = map.optional("end_radius")) route.end_radius = read_radius(*end);
  if (const auto turn = map.optional("turn")) {
    const double angle = turn->quantity(Dimension::angle, Range::between(-1000, 1000));
    const int discs = arm_.sections[section].discs.count;
    if (discs > 0 && std::abs(angle) >= std::numbers::pi * discs)
      turn->refuse("out_of_range",
                   fmt::format("with {} it must turn by less than 180 deg from each to the next.",
                               discs == 1 ? "one disc" : fmt::format("{} discs", discs)));
    route.end_angle += angle;
  }
  return route;
}

/// Through the sections before its own: as the file says, else parallel to the backbone.
void ArmReader::read_routes_before(Reader& tendon, const TendonRoute& own, std::vector<TendonRoute>& routes) {
  const std::size_t before = arm_.sections.size() - 1;
  const auto through = tendon.optional("through");
  if (!through) {
    routes.assign(before, {own.start_radius, own.start_radius, own.start_angle, own.start_angle});
    return;
  }
  auto items = through->items();
  const std::string needed = fmt::format("{} section{}", before, before == 1 ? "" : "s");
  if (items.size() > before)
    through->fail("guide_beyond_tip",
                  fmt::format("there are {} entries, and the tendon passes {} before its own, where it ends; "
                              "{}.",
                              items.size(), needed,
                              before == 0 ? "leave through out" : fmt::format("list {}", before)));
  else if (items.size() < before && through->is(Node::Kind::list))
    through->fail("missing_guide",
                  fmt::format("there are {} entries, and the tendon passes {} before its own; "
                              "list one for each, base first.",
                              items.size(), needed));
  for (std::size_t m = 0; m < std::min(items.size(), before); ++m) {
    if (!items[m].is(Node::Kind::map)) {
      items[m].refuse("wrong_type", "give a map: {radius, angle}.");
      continue;
    }
    routes.push_back(read_route(items[m], m, own));
    items[m].close();
  }
  routes.resize(before, own);
}

void ArmReader::check_radius(const Reader& place, double radius, std::size_t section) const {
  const double disc = arm_.sections[section].discs.radius;
  if (disc == 0 || radius <= disc) return;
  if (section + 1 == arm_.sections.size())
    place.refuse("out_of_range", fmt::format("the disc's radius is {}: the tendons would run outside it",
                                             human(disc, Dimension::length)));
  else
    place.refuse(
        "out_of_range",
        fmt::format("in sections[{}], which the tendon passes, the disc's radius is {}: it would run "
                    "outside it; say where it runs there by through",
                    section, human(disc, Dimension::length)));
}

void ArmReader::read_properties(Reader& map, ArmTendon& tendon) {
  std::optional<TendonStretch> stretch = stretch_;
  const auto compliance = map.optional("compliance");
  auto own = map.optional("stretch");
  if (own) stretch = read_stretch(*own);
  if (compliance && own)
    compliance->refuse("ambiguous", "compliance and stretch both say how the tendon yields; keep one");
  if (compliance) {
    tendon.compliance = compliance->quantity(Dimension::compliance, Range::between(0, max_compliance));
  } else if (stretch) {
    double length = stretch->outside;
    for (std::size_t m = 0; m < tendon.routes.size(); ++m)
      length += straight_length(tendon.routes[m], arm_.sections[m]);
    tendon.compliance = length / stretch->stiffness;
    tendon.outside = std::min(1.0, stretch->outside / length);
    if (!(tendon.compliance <= max_compliance))
      (own ? *own : map).fail("out_of_range", "stretch makes tendons softer than any are; is a unit wrong?");
  }
  if (const auto outside = map.optional("outside")) {
    if (own) outside->refuse("ambiguous", "stretch has a length outside, which says the same; keep one");
    tendon.outside = outside->number(Range::between(0, 1));
  }
  if (const auto friction = map.optional("friction"))
    tendon.friction = friction->number(Range::between(0, 100));
  if (const auto pretension = map.optional("pretension"))
    tendon.pretension = pretension->quantity(Dimension::force, Range::between(0, 1e9));
}

}  // namespace

Arm read_arm_of_leg(Reader& link, const Errors& errors) {
  return ArmReader(link, errors).read_sections_alone();
}

bool is_arm(const Document& document) {
  if (!is_serial(document)) return false;
  const Node* sections = document.root.find("sections");
  if (!sections) return false;
  if (sections->kind == Node::Kind::map) return type_of(*sections) == elastic;
  return std::ranges::any_of(sections->items, [](const Node& one) { return type_of(one) == elastic; });
}

Expected<Arm> read_arm(const Document& document) {
  if (auto fits = check_size(document); !fits) return tl::unexpected(fits.error());
  const Expected<Document> longer = expanded_sections(document);
  if (!longer) return tl::unexpected(longer.error());
  Errors errors;
  Reader robot = Reader(document, errors).over(longer->root);  // what sections share is told once
  Arm arm = ArmReader(robot, errors).read();
  if (!errors.empty()) return tl::unexpected(errors);
  return arm;
}

}  // namespace sinew::inline v1
