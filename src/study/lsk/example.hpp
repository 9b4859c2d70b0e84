/// @file example.hpp
/// The robot of [LSK] Table 2 in the paper's figures: what is printed of it, its section diagrams and how
/// they are drawn, in degrees. Theory: docs/theory/model_error.md, docs/theory/section_diagram.md
#pragma once
#include <string>
#include <vector>

#include "io/figure/figure.hpp"
#include "sinew/io/table.hpp"
#include "sinew/robot/serial.hpp"
#include "sinew/tendon/diagram.hpp"
#include "study/reproduce.hpp"

namespace sinew::inline v1::lsk {

inline constexpr double degree = std::numbers::pi / 180;

/// Table 2, [mm], [deg].
struct Printed {
  int sections = 5, segments = 8, tendons = 3;
  double length = 175, joint = 2.375, disc = 2, tendon_radius = 2.45, limit = 24, turn = 24;
};
inline constexpr Printed printed{};

/// First lines of every file.
std::vector<std::string> provenance(const std::string& id, const std::string& what);

/// A bend in degrees.
inline Bend in_degrees(double x, double y) { return {x * degree, y * degree}; }

/// LSK of the tendons of a section alone, all paid out `slack` more [m].
std::vector<double> changes_of(const Section& section, const Bend& bend, double slack);

/// Diagram of the first section; square or disc as its backbone has it, tolerance 1 nm.
SectionDiagram diagram_of(const Section& section, const std::vector<double>& changes);
/// The same with another envelope.
SectionDiagram diagram_of(const Section& section, const std::vector<double>& changes,
                          const Envelope& envelope);

std::string text(TendonConsistency agree);
std::string text(const Bend& bend);  ///< `(10°, −5°)`

// ---------------------------------------------------------------- drawing

/// Empty square panel over ±reach [deg].
Panel plane(std::string title, double reach, const char* x, const char* y, double step);

Series closed(const Polygon& corners, Mark mark, Colour colour, std::string label, double width = 1.5);
Series line(const Vec2<double>& from, const Vec2<double>& to, Mark mark, Colour colour, std::string label,
            double width = 1.5);
Series dot(const Vec2<double>& at, Mark mark, Colour colour, std::string label, double width = 5);

/// |x|, |y| ≤ limit [rad].
Polygon square(double limit);
/// A circle about the origin [rad].
Polygon circle(double radius);

/// The part of a frontier that lies within ±reach [rad].
Polygon visible(const HalfPlane& frontier, double reach);

/// Frontiers of all tendons, named, and from the origin the vectors they are perpendicular to.
void add_frontiers(Panel& panel, const SectionDiagram& diagram, double reach);

}  // namespace sinew::inline v1::lsk
