/// @file robot_drawing.hpp
/// Pieces of a picture of a planar robot. Points and lengths come in metres, the panel is in mm.
#pragma once
#include <string>

#include "io/figure/figure.hpp"
#include "sinew/analysis/shape.hpp"

namespace sinew::inline v1::drawing {

using Point = Vec2<double>;

Point at_angle(double radius, double degrees);  ///< about the origin, from the x axis

Series curve(std::string label, const Polyline& points, Mark mark, Colour colour, double width);

Note text(std::string words, const Point& at, Note::Side side = Note::Side::centre,
          Colour colour = Colour::black);

Polyline circle(const Point& centre, double radius);

/// Empty panel from corner to corner, axes x and y in mm, equal aspect, no legend.
Panel plane(std::string title, const Point& low, const Point& high, double step);

/// A thin line with an open head of this length, for axes and dimensions.
void add_arrow(Panel& panel, const Point& from, const Point& to, double head);

/// A thin line to a text, with a dot on what it names.
void add_leader(Panel& panel, const Point& named, const Point& words);

/// Grey base or green platform. The label is for the legend.
void add_base(Panel& panel, const PlanarShape& robot, std::string label);
void add_platform(Panel& panel, const PlanarShape& robot, std::string label);

/// Open circles at both ends of every leg.
void add_joints(Panel& panel, const PlanarShape& robot, std::string label);

/// A₁, A₂ … outside the base.
void add_base_names(Panel& panel, const PlanarShape& robot, double distance);

/// B₁, B₂ … about the platform's centre.
/// @param turn from a point's direction to its name's [deg], the same for all legs: where no leg arrives
void add_platform_names(Panel& panel, const PlanarShape& robot, const Point& centre, double distance,
                        double turn);

}  // namespace sinew::inline v1::drawing
