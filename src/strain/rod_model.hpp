/// @file rod_model.hpp
/// A rod as its strains: what a robot and a choice of bases become, and the memory to solve it in. Theory:
/// docs/theory/strain_rod.md
///
/// A rod is a row of pieces, each with coordinates of its own; a piece is a row of spans, from disc to disc;
/// a span is a row of elements. A strain is (v, u): stretch and shear, then bending and torsion, in body
/// axes, z along the rod. Twists and wrenches are linear first, in the axes of the node that they belong to.
#pragma once
#include <array>
#include <vector>

namespace sinew::inline v1::strain {

/// Of rows of six numbers: a register of eight lanes.
inline constexpr int row = 8;
/// Of a strain component along a piece.
inline constexpr int max_modes = 32;
/// Coordinates of a piece.
inline constexpr int max_piece = 128;
/// Tendons through a disc.
inline constexpr int most_holes = 32;

using Three = std::array<double, 3>;
using Six = std::array<double, 6>;
/// Rows first, columns 6 and 7 are 0.
struct alignas(64) Block {
  double a[6][row];
};

/// A short length of the rod over which the strain is integrated by two Gauss points (a Magnus step of fourth
/// order); or a joint, which turns at one place.
struct Element {
  double length = 0;                                     ///< h [m]; of a joint 0
  double commutator = 0;                                 ///< √3 h²/12 [m²]; of a joint 0
  int points = 2;                                        ///< Gauss points; of a joint 1
  double weight = 0;                                     ///< of each of them: h/2 [m]; of a joint 1
  std::array<Six, 2> rest{};                             ///< strain without load
  std::array<Six, 2> stiffness{};                        ///< its diagonal [N], [N m²]; of a joint [N m]
  std::array<std::array<double, max_modes>, 2> modes{};  ///< values of the basis
  double from = 0, to = 0;                               ///< the places between which its polynomials run [m]
  int stretch = 0;                                       ///< which stretch of its piece that is
  int first_row = 0;                ///< in RodModel::rows: the same, scaled, for each point 6 × padded
  int first_guide = 0, guides = 0;  ///< in RodModel::guides: tendons that a channel guides along the rod
  bool is_pivot = false;            ///< a joint that turns freely, see RodModel::pivots
};

/// A tendon in a channel: where it runs at the Gauss points of an element.
struct Guide {
  int tendon = 0;
  /// r [m] and dr/ds [1], in body axes; at a joint, whose strain is its turn alone, how far and which way the
  /// tendon runs past it at rest [m].
  std::array<Three, 2> place{}, slope{};
};

/// A tendon between two discs: the holes that it runs through.
struct Hole {
  int tendon = 0;
  Three start{}, end{};  ///< in the axes of the disc before and after [m]
};

struct Span {
  int first_element = 0, elements = 0;
  int first_hole = 0, holes = 0;  ///< in RodModel::holes
};

/// Strains of a piece are rest + scale_c Σ modes_a y_{c,a}; the scale makes the elastic energy ½|y|².
struct Piece {
  int first_span = 0, spans = 0;
  int first = 0, size = 0;     ///< of its coordinates
  int padded = 0;              ///< `size` rounded up to whole registers
  std::array<int, 6> modes{};  ///< of each component; 0: the strain stays at rest
  int stretches =
      1;  ///< with polynomials of their own, between point loads; each has an equal part of the modes
  std::array<int, 6> offset{};  ///< of its first coordinate in the piece
  Six scale{};
};

/// What is spread along the rod, as it falls to a node: mass of discs and of the rod beside it; or length.
struct NodeShare {
  double amount = 0;  ///< [kg]; [m]
  Three moment{};     ///< its first moment about the node, in body axes [kg m]; [m²]
};

/// Constant once built.
struct RodModel {
  std::vector<Element> elements;
  std::vector<Span> spans;
  std::vector<Piece> pieces;
  std::vector<Guide> guides;
  std::vector<Hole> holes;
  std::vector<double> rows;                ///< strains by coordinates, see Element::first_row
  std::vector<NodeShare> masses, lengths;  ///< of every node; node k + 1 is the end of element k
  std::vector<double> places;              ///< of every node, from the base [m]
  /// Coordinates of joints that turn freely. What the sweeps give of such a joint is that of one with the
  /// stiffness 1 of the energy ½|y|²: who has them takes it back.
  std::vector<int> pivots;
  int tendons = 0, size = 0;
  double energy_scale = 1;  ///< EI/L [J]

  int nodes() const { return static_cast<int>(elements.size()) + 1; }
};

/// A frame: where, and a rotation matrix, rows first.
struct RodFrame {
  double p[3];
  double R[9];
};

/// Loads on a node. Dead ones keep their direction in space, following ones in the node.
struct NodeLoad {
  double force[3] = {};      ///< dead [N]
  double couple[9] = {};     ///< Σ f dᵀ of dead forces f at body points d [N m]
  double moment[3] = {};     ///< dead; has no potential [N m]
  double following[6] = {};  ///< force and moment in the node's axes; no potential
};

/// The load at this share of the way from one to another.
inline NodeLoad mix(const NodeLoad& a, const NodeLoad& b, double share) {
  NodeLoad load;
  const auto each = [share](const double* from, const double* to, double* out, int count) {
    for (int i = 0; i < count; ++i) out[i] = from[i] + share * (to[i] - from[i]);
  };
  each(a.force, b.force, load.force, 3);
  each(a.couple, b.couple, load.couple, 9);
  each(a.moment, b.moment, load.moment, 3);
  each(a.following, b.following, load.following, 6);
  return load;
}

/// What a Newton step needs of a piece: its Hessian, and how it passes a twist on.
struct PieceTerms {
  std::vector<double> H;        ///< size × padded
  std::vector<double> R, L, G;  ///< 6 × padded: twist–coordinates, its transpose's partner, end's twist
  Block P, A;                   ///< of the twist at the start; twist at the end of that at the start
  std::vector<double> factor;   ///< LDLᵀ or LU of the condensed H
  std::vector<int> pivots;
  std::vector<double> fed;  ///< 6 × padded: R̂, L̂ transposed and solved
  Block value;              ///< P̃ at the start, all after it eliminated
};

/// Memory of one solve; one thread uses it.
struct RodWork {
  std::vector<double> y, gradient;
  std::vector<RodFrame> frames;                  ///< of nodes
  std::vector<std::array<double, 9 + 3>> steps;  ///< of elements: rotation and translation of exp Ω
  std::vector<std::array<double, 6>> omega;      ///< Ω of elements
  std::vector<std::array<Six, 2>> strains;
  std::vector<NodeLoad> loads;
  std::vector<double> hole_tension, guide_tension;  ///< of each entry [N]
  std::vector<double> lengths;                      ///< of tendons [m]
  std::vector<double> length_gradient;              ///< tendons × size
  bool finds_length_gradients = true;               ///< whether sweeps back do; who holds tensions needs none
  std::vector<PieceTerms> pieces;
  std::vector<double> scratch;
  double energy = 0;  ///< elastic and of loads that have a potential, without tendons [J]
  bool symmetric = true;

  explicit RodWork(const RodModel& model);
};

}  // namespace sinew::inline v1::strain
