#include "io/robots/arm_backbone.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "io/document/reader.hpp"
#include "io/robots/read_material.hpp"

namespace sinew::inline v1 {
namespace {

/// At the start of a section and at its end, where Young's modulus may be another.
std::pair<Material, Material> read_materials(Reader& backbone) {
  Material start{.young = 1, .shear = 1, .density = 0};
  Reader map = backbone.required("material", "{E, poisson or G, density}");
  if (!map.is(Node::Kind::map)) {
    if (map.node()) map.refuse("wrong_type", "give a map of E, poisson or G, and density.");
    return {start, start};
  }
  start.young = map.required("E", "Young's modulus").quantity(Dimension::pressure, Range::positive());
  if (const auto shear = read_shear_modulus(map, start.young))
    start.shear = *shear;
  else
    map.fail("missing_key", "an elastic section twists; it needs G, or poisson: Poisson's ratio");
  if (const auto density = map.optional("density"))
    start.density = density->quantity(Dimension::density, Range::not_negative());
  Material end = start;
  if (const auto young = map.optional("end_E")) {
    end.young = young->quantity(Dimension::pressure, Range::positive());
    end.shear *= end.young / start.young;
  }
  map.close();
  return {start, end};
}

/// A wire or tube; drawn thinner, its hole keeps its share of the diameter.
void read_round(ArmSection& section, Reader& backbone, const Material& start, const Material& end) {
  const double outer =
      backbone.required("diameter", "of a round backbone; or width and height, or bending and torsion")
          .quantity(Dimension::length, Range::size());
  double inner = 0, end_outer = outer;
  if (const auto hole = backbone.optional("hole"))
    inner = hole->quantity(Dimension::length, {.low = 0, .high = outer, .high_excluded = true});
  if (const auto taper = backbone.optional("end_diameter")) {
    end_outer = taper->quantity(Dimension::length, Range::size());
    section.round_taper = end_outer != outer;
    if (section.round_taper && end.young != start.young)
      taper->refuse("not_available",
                    "diameter and end_E cannot both change along one section; divide it into sections.");
  }
  section.start = round_section(start, outer, inner);
  section.end = round_section(end, end_outer, inner * end_outer / outer);
}

void read_rectangle(ArmSection& section, Reader& backbone, const Material& start, const Material& end) {
  const double width = backbone.required("width", "along x").quantity(Dimension::length, Range::size()),
               height = backbone.required("height", "along y").quantity(Dimension::length, Range::size());
  section.start = rectangular_section(start, width, height);
  section.end = rectangular_section(end, width, height);
}

void read_bending(CrossSection& s, const Reader& bending) {
  if (bending.is(Node::Kind::list)) {
    const auto [x, y] = bending.array<2>(Dimension::rigidity, Range::positive());
    s.bending_x = x;
    s.bending_y = y;
  } else {
    s.bending_x = s.bending_y = bending.quantity(Dimension::rigidity, Range::positive());
  }
}

void read_rest_of_stiffness(CrossSection& s, Reader& map) {
  if (const auto stretch = map.optional("stretch"))
    s.stretch = stretch->quantity(Dimension::force, Range::positive());
  if (const auto shear = map.optional("shear"))
    s.shear = shear->quantity(Dimension::force, Range::positive());
  if (const auto mass = map.optional("mass"))
    s.mass = mass->quantity(Dimension::line_mass, Range::not_negative());
}

/// What a geometry that no sizes describe resists with, as it was measured.
void read_stiffness(ArmSection& section, Reader& backbone) {
  CrossSection& s = section.start;
  read_bending(s, backbone.required("bending", "E I: one rigidity, or [about x, about y]"));
  s.torsion = backbone.required("torsion", "G J").quantity(Dimension::rigidity, Range::positive());
  read_rest_of_stiffness(s, backbone);
  section.end = s;
  auto end = backbone.optional("end");
  if (end) {
    if (const auto bending = end->optional("bending")) read_bending(section.end, *bending);
    if (const auto torsion = end->optional("torsion"))
      section.end.torsion = torsion->quantity(Dimension::rigidity, Range::positive());
    read_rest_of_stiffness(section.end, *end);
    end->close();
  }
  if (const auto taper = backbone.optional("taper")) {
    section.round_taper = taper->choice({"linear", "round"}) == "round";
    if (!end) taper->fail("no_effect", "without end nothing tapers; give end, or leave taper out");
  }
}

void read_sizes(ArmSection& section, Reader& backbone) {
  const auto [start, end] = read_materials(backbone);
  const bool is_rectangle = backbone.has("width") || backbone.has("height");
  const auto diameter = backbone.optional("diameter");
  if (is_rectangle && diameter)
    diameter->refuse("ambiguous", "diameter and width both say how thick the backbone is; keep one");
  if (is_rectangle && !diameter)
    read_rectangle(section, backbone, start, end);
  else
    read_round(section, backbone, start, end);
  if (const auto law = backbone.optional("law"); law && law->choice({"cosserat", "kirchhoff"}) == "kirchhoff")
    for (CrossSection* one : {&section.start, &section.end}) one->stretch = one->shear = 0;
}

/// Whether products of sizes and moduli are far from the ends of the doubles.
bool is_moderate(const CrossSection& s) {
  constexpr double least = 1e-40, most = 1e40;
  const auto is_within = [](double low) { return [low](double v) { return v >= low && v <= most; }; };
  return std::ranges::all_of(std::array{s.bending_x, s.bending_y, s.torsion}, is_within(least)) &&
         std::ranges::all_of(std::array{s.stretch, s.shear, s.mass}, is_within(0));
}

}  // namespace

void read_backbone_into(ArmSection& section, Reader& backbone) {
  if (!backbone.is(Node::Kind::map)) {
    if (backbone.node()) backbone.refuse("wrong_type", "give a map: {diameter, material: {E, poisson}}.");
    return;
  }
  const bool has_stiffness = backbone.has("bending") || backbone.has("torsion");
  if (const auto material = backbone.optional("material"); has_stiffness && material) {
    material->fail("ambiguous", "material and bending both say how stiff the backbone is; keep one");
    return;
  }
  if (has_stiffness)
    read_stiffness(section, backbone);
  else
    read_sizes(section, backbone);
  backbone.close();
  if (!is_moderate(section.start) || !is_moderate(section.end))
    backbone.fail("out_of_range",
                  "sizes and material give a stiffness that no backbone has; is a unit wrong?");
}

}  // namespace sinew::inline v1
