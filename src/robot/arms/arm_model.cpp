#include "robot/arms/arm_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/at.hpp"

namespace sinew::inline v1 {
namespace {

using strain::Element;
using strain::Guide;
using strain::Hole;
using strain::Piece;
using strain::RodModel;
using strain::Six;
using strain::Span;
using strain::Three;

/// At a share of the section's length.
CrossSection section_at(const ArmSection& section, double share) {
  const auto mix = [&](double a, double b, double power) {
    if (!section.round_taper) return a + share * (b - a);
    const double x = std::pow(a, 1 / power), y = std::pow(b, 1 / power);
    return std::pow(x + share * (y - x), power);
  };
  const CrossSection &a = section.start, &b = section.end;
  return {mix(a.bending_x, b.bending_x, 4), mix(a.bending_y, b.bending_y, 4), mix(a.torsion, b.torsion, 4),
          mix(a.stretch, b.stretch, 2),     mix(a.shear, b.shear, 2),         mix(a.mass, b.mass, 2)};
}

Three place_of(const TendonRoute& route, double share) {
  const double radius = route.start_radius + share * (route.end_radius - route.start_radius),
               angle = route.start_angle + share * (route.end_angle - route.start_angle);
  return {radius * std::cos(angle), radius * std::sin(angle), 0};
}
/// dr/ds.
Three slope_of(const TendonRoute& route, double share, double length) {
  const double radius = route.start_radius + share * (route.end_radius - route.start_radius),
               angle = route.start_angle + share * (route.end_angle - route.start_angle),
               grows = (route.end_radius - route.start_radius) / length,
               turns = (route.end_angle - route.start_angle) / length;
  return {grows * std::cos(angle) - radius * turns * std::sin(angle),
          grows * std::sin(angle) + radius * turns * std::cos(angle), 0};
}

/// √(2a+1) P_a(x), x in [−1, 1].
void legendre(double x, int modes, double scale, std::array<double, strain::max_modes>& values) {
  double before = 0, value = 1;
  for (int a = 0; a < modes; ++a) {
    values[at(a)] = std::sqrt(2.0 * a + 1) * value * scale;
    const double next = ((2.0 * a + 1) * x * value - a * before) / (a + 1);
    before = value;
    value = next;
  }
}

/// A beam as four links on three joints, of shares that sum up to 0.999 in the source, and the joints'
/// stiffness over EI/L: the field's pseudo-rigid-body model.
constexpr std::array<double, 4> beam_links{0.125, 0.35, 0.388, 0.136};
constexpr std::array<double, 3> beam_stiffness{3.25, 2.84, 2.95};
constexpr double beam_length = beam_links[0] + beam_links[1] + beam_links[2] + beam_links[3];

/// Of bending and torsion where none is asked for.
int usual_order(ArmModel model) {
  if (model == ArmModel::cc || model == ArmModel::subsegment_cc) return 0;
  return model == ArmModel::rod ? 3 : 2;
}

/// Elements by the order: from the usual ones the quadrature's error, of the fourth power of their length,
/// falls with each order as that of the polynomials does.
constexpr std::array<int, 10> elements_between_discs{2, 2, 2, 3, 5, 8, 13, 20, 32, 50},
    elements_of_section{8, 8, 8, 8, 12, 16, 24, 32, 48, 64};

/// Share of a section's length below which a span is none.
constexpr double least_span = 1e-9;

class Builder {
 public:
  Builder(const Arm& arm, const ArmBasis& basis) : arm_(arm), basis_(basis) {
    basis_.elements = elements_of(basis);
    rod_.tendons = static_cast<int>(arm.tendons.size());
    rod_.masses.resize(1);
    rod_.lengths.resize(1);
    rod_.places.assign(1, 0.0);
  }

  RodModel build(std::vector<double> breaks) {
    std::ranges::sort(breaks);
    double from = 0, bending = 0;
    for (const ArmSection& section : arm_.sections)
      bending += section.length / std::min(section.start.bending_x, section.start.bending_y);
    rod_.energy_scale = 1 / bending;
    if (basis_.turns_at_base) add_pivot(0);
    for (std::size_t m = 0; m < arm_.sections.size(); ++m) {
      const ArmSection& section = arm_.sections[m];
      std::vector<double> cuts;
      for (double place : breaks)
        if (place > from + 1e-12 && place < from + section.length - 1e-12)
          cuts.push_back((place - from) / section.length);
      add_section(static_cast<int>(m), cuts);
      from += section.length;
    }
    if (basis_.strut > 0) {
      add_pivot(basis_.strut_angle);
      add_strut(basis_.strut);
    }
    for (Piece& piece : rod_.pieces) {
      piece.first = rod_.size;
      rod_.size += piece.size;
      if (rod_.elements[at(rod_.spans[at(piece.first_span)].first_element)].is_pivot)
        rod_.pivots.push_back(piece.first);
      add_rows(piece);
    }
    rod_.masses.back().amount += arm_.tip_mass;
    for (std::size_t i = 0; i < 3; ++i)
      rod_.masses.back().moment[i] += arm_.tip_mass * arm_.tip_mass_place[i];
    return std::move(rod_);
  }

 private:
  /// Whether there may be a strain of this component.
  bool is_free(std::size_t component) const { return !basis_.in_plane || component % 2 == 0; }
  bool by_section() const { return basis_.model == ArmModel::rod || basis_.model == ArmModel::cc; }
  int modes() const { return order_of(basis_) + 1; }

  /// Shares of the section's length at which spans end.
  std::vector<double> span_ends(const ArmSection& section, const std::vector<double>& cuts) const {
    const bool channel = section.discs.count == 0 || basis_.model == ArmModel::rod;
    int spans = section.discs.count;
    if (channel) spans = by_section() ? 1 : std::max(basis_.elements, 10);
    std::vector<double> ends;
    for (int k = 1; k <= spans; ++k) ends.push_back(static_cast<double>(k) / spans);
    if (!channel || basis_.model == ArmModel::prb) return ends;  // where joints are does not depend on loads
    ends.insert(ends.end(), cuts.begin(), cuts.end());
    std::sort(ends.begin(), ends.end());
    // A load where a span ends anyway, or two loads at one place: a span without length has no strain.
    std::vector<double> apart;
    for (const double end : ends)
      if (end > (apart.empty() ? 0 : apart.back()) + least_span) apart.push_back(end);
    apart.back() = 1;
    return apart;
  }

  void add_section(int m, const std::vector<double>& cuts) {
    const ArmSection& section = arm_.sections[at(m)];
    const bool channel = section.discs.count == 0 || basis_.model == ArmModel::rod;
    double start = 0;
    const std::size_t first = rod_.places.size() - 1;
    const auto ends = span_ends(section, cuts);
    if (basis_.model == ArmModel::cc) begin_piece(section, 0, 1, 1, {});
    const std::vector<double> none;
    for (double end : ends) {
      const int elements = basis_.model == ArmModel::cc ? 1 : basis_.elements;
      if (basis_.twist_at_discs) {
        add_bending(m, start, end, cuts);
        start = end;
        continue;
      }
      if (basis_.model == ArmModel::prb)
        begin_joints(section, start, end, elements, (end - start) * section.length / elements, true);
      else if (basis_.model != ArmModel::cc)
        begin_piece(section, start, end, modes(), inner_cuts(channel ? none : cuts, start, end));
      if (basis_.model == ArmModel::prb) {
        begin_span();
        add_joints(m, start, end, elements, cuts);
        if (!channel) {
          add_holes(m, start, end);
          rod_.masses.back().amount += section.discs.mass;
        }
      } else if (channel) {  // every element is a span of its own: no tendon runs straight
        for (int e = 0; e < elements; ++e) {
          const double a = start + (end - start) * e / elements,
                       b = start + (end - start) * (e + 1) / elements;
          begin_span();
          add_elements(m, a, b);
        }
      } else {
        begin_span();
        // Each stretch has as many elements as a whole span: its polynomials need their Gauss points.
        std::vector<double> stops{start};
        for (const double cut : cuts)
          if (cut > start + 1e-9 && cut < end - 1e-9 && cut > stops.back() + 1e-9) stops.push_back(cut);
        stops.push_back(end);
        for (std::size_t k = 0; k + 1 < stops.size(); ++k)
          for (int e = 0; e < elements; ++e) {
            const double length = stops[k + 1] - stops[k];
            add_elements(m, stops[k] + length * e / elements, stops[k] + length * (e + 1) / elements);
          }
        add_holes(m, start, end);
        rod_.masses.back().amount += section.discs.mass;
      }
      start = end;
    }
    if (channel && section.discs.mass > 0) add_discs(section, first);
    place_ += section.length;
  }

  /// A joint that turns freely about y, a piece of its own.
  /// @param angle at which its coordinate is 0 [rad]
  void add_pivot(double angle) {
    Piece piece;
    piece.modes[4] = piece.size = 1;
    piece.scale[4] = 1 / std::sqrt(rod_.energy_scale);
    begin(piece);
    begin_span();
    Element element;
    element.points = 1;
    element.weight = 1;
    element.is_pivot = true;
    element.rest[0][4] = angle;
    element.stiffness[0][4] = rod_.energy_scale;
    element.modes[0][0] = 1;
    push_bare(element);
  }
  /// A rigid bar without mass, of the piece at hand.
  void add_strut(double length) {
    Element bar;
    bar.points = 0;
    bar.length = length;
    for (auto& rest : bar.rest) rest = {0, 0, 1, 0, 0, 0};
    push_bare(bar);
  }
  void push_bare(const Element& element) {
    rod_.elements.push_back(element);
    ++rod_.spans.back().elements;
    rod_.masses.emplace_back();
    rod_.lengths.emplace_back();
    rod_.places.push_back(rod_.places.back() + element.length);
  }

  /// Joints in the middle of even links, and rigid links between them and point loads.
  void add_joints(int m, double start, double end, int joints, const std::vector<double>& cuts) {
    const ArmSection& section = arm_.sections[at(m)];
    const double length = (end - start) * section.length / joints;
    std::vector<std::pair<double, int>> stops;
    for (int k = 0; k < joints; ++k) stops.emplace_back(start + (end - start) * (k + 0.5) / joints, k);
    for (const double cut : cuts)
      if (cut > start + 1e-9 && cut < end - 1e-9) stops.emplace_back(cut, -1);
    std::ranges::sort(stops);
    double a = start;
    for (const auto& [place, joint] : stops) {
      if (place > a) add_rigid(section, a, place);
      if (joint >= 0) add_joint(section, place, joint, length);
      if (joint >= 0 && section.discs.count == 0) add_joint_guides(m, place, length);
      a = place;
    }
    add_rigid(section, a, end);
  }

  /// What lies between two discs and only bends, then the joint at the disc where it twists.
  void add_bending(int m, double start, double end, const std::vector<double>& cuts) {
    const ArmSection& section = arm_.sections[at(m)];
    const double length = (end - start) * section.length;
    if (basis_.model == ArmModel::prb) {
      begin_joints(section, start, end, static_cast<int>(beam_stiffness.size()), length, false);
      begin_span();
      double a = start;
      for (std::size_t k = 0; k < beam_links.size(); ++k) {
        const double b = k + 1 == beam_links.size() ? end : a + beam_links[k] * (end - start) / beam_length;
        add_rigid(section, a, b);
        if (k < beam_stiffness.size()) add_joint(section, b, static_cast<int>(k), length / beam_stiffness[k]);
        a = b;
      }
    } else {
      begin_piece(section, start, end, 1, {});
      begin_span();
      double a = start;
      for (const double cut : cuts)
        if (cut > start + 1e-12 && cut < end - 1e-12) {
          add_elements(m, a, cut);
          a = cut;
        }
      add_elements(m, a, end);
    }
    for (Element* e = &rod_.elements[at(rod_.spans.back().first_element)]; e != &rod_.elements.back() + 1;
         ++e)
      for (auto& rest : e->rest) rest[5] = 0;
    add_holes(m, start, end);
    Piece twist;
    twist.modes[5] = twist.size = 1;
    twist.scale[5] = std::sqrt(length / section_at(section, 0.5 * (start + end)).torsion);
    begin(twist);
    begin_span();
    add_joint(section, end, 0, length);
    rod_.elements.back().rest[0][5] = length * section.curvature[2];
    rod_.masses.back().amount += section.discs.mass;
  }

  /// Discs of a section that has nodes elsewhere: each falls to two nodes, as a cubic between them says.
  void add_discs(const ArmSection& section, std::size_t node) {
    for (int k = 1; k <= section.discs.count; ++k) {
      const double place = place_ + section.length * k / section.discs.count;
      while (node + 2 < rod_.places.size() && rod_.places[node + 1] < place) ++node;
      const double h = rod_.places[node + 1] - rod_.places[node], t = (place - rod_.places[node]) / h,
                   u = 1 - t, mass = section.discs.mass;
      rod_.masses[node].amount += mass * u * u * (1 + 2 * t);
      rod_.masses[node].moment[2] += mass * h * t * u * u;
      rod_.masses[node + 1].amount += mass * t * t * (3 - 2 * t);
      rod_.masses[node + 1].moment[2] -= mass * h * t * t * u;
    }
  }

  /// Cuts within a span, where a point load makes a kink in the strain.
  std::vector<double> inner_cuts(const std::vector<double>& cuts, double start, double end) const {
    std::vector<double> inner;
    if (modes() == 1) return inner;  // constant is constant
    for (const double cut : cuts)
      if (cut > start + 1e-9 && cut < end - 1e-9 && inner.size() < 3 &&
          (inner.empty() || cut > inner.back() + 1e-9))
        inner.push_back(cut);
    return inner;
  }

  /// @param cuts shares at which its polynomials end and others begin
  void begin_piece(const ArmSection& section, double start, double end, int modes,
                   const std::vector<double>& cuts) {
    Piece piece;
    const double mid = 0.5 * (start + end);
    const CrossSection here = section_at(section, mid);
    const Six stiffness{here.shear, here.shear, here.stretch, here.bending_x, here.bending_y, here.torsion};
    piece.stretches = static_cast<int>(cuts.size()) + 1;
    modes = std::min(modes, strain::max_piece / 6 / piece.stretches);
    // What is stiff follows with one order less than the model's.
    const bool fine = basis_.order < 0 && cuts.empty();
    const int stiff_modes = fine ? std::min(modes, usual_order(basis_.model)) : modes;
    for (std::size_t c = 0; c < 6; ++c) {
      if (stiffness[c] <= 0 || !is_free(c)) continue;
      if (c == 5 && basis_.twist_at_discs) continue;
      if (c < 3 && (basis_.model == ArmModel::cc || basis_.model == ArmModel::subsegment_cc)) continue;
      piece.modes[c] = piece.stretches * (c < 3 ? stiff_modes : modes);
      piece.scale[c] = 1 / std::sqrt(stiffness[c]);
      piece.offset[c] = piece.size;
      piece.size += piece.modes[c];
    }
    begin(piece);
    stretches_ = {start};
    stretches_.insert(stretches_.end(), cuts.begin(), cuts.end());
    stretches_.push_back(end);
    most_modes_ = modes;
  }
  /// @param length that the stiffness of a joint stands for [m]
  void begin_joints(const ArmSection& section, double start, double end, int joints, double length,
                    bool twists) {
    Piece piece;
    const CrossSection here = section_at(section, 0.5 * (start + end));
    const Six stiffness{0, 0, 0, here.bending_x / length, here.bending_y / length, here.torsion / length};
    for (std::size_t c = 3; c < (twists ? 6U : 5U); ++c) {
      if (!is_free(c)) continue;
      piece.modes[c] = joints;
      piece.scale[c] = 1 / std::sqrt(stiffness[c]);
      piece.offset[c] = piece.size;
      piece.size += joints;
    }
    begin(piece);
  }
  void begin(Piece& piece) {
    piece.first_span = static_cast<int>(rod_.spans.size());
    piece.padded = (piece.size + strain::row - 1) / strain::row * strain::row;
    rod_.pieces.push_back(piece);
  }
  void add_rows(const Piece& piece) {
    for (int s = piece.first_span; s < piece.first_span + piece.spans; ++s) {
      const Span& span = rod_.spans[at(s)];
      for (int e = span.first_element; e < span.first_element + span.elements; ++e) {
        Element& element = rod_.elements[at(e)];
        element.first_row = static_cast<int>(rod_.rows.size());
        for (int g = 0; g < element.points; ++g)
          for (std::size_t c = 0; c < 6; ++c) {
            std::vector<double> values(at(piece.padded), 0.0);
            for (int a = 0; a < piece.modes[c]; ++a)
              values[at(piece.offset[c] + a)] = piece.scale[c] * element.modes[at(g)][at(a)];
            rod_.rows.insert(rod_.rows.end(), values.begin(), values.end());
          }
      }
    }
  }
  void begin_span() {
    Span span;
    span.first_element = static_cast<int>(rod_.elements.size());
    span.first_hole = static_cast<int>(rod_.holes.size());
    rod_.spans.push_back(span);
    ++rod_.pieces.back().spans;
  }

  void add_elements(int m, double a, double b) {
    const ArmSection& section = arm_.sections[at(m)];
    Element element = straight(section, a, b);
    while (at(element.stretch) + 2 < stretches_.size() && stretches_[at(element.stretch) + 1] <= a + 1e-12)
      ++element.stretch;
    const double from = stretches_[at(element.stretch)], to = stretches_[at(element.stretch) + 1];
    element.from = place_ + from * section.length;
    element.to = place_ + to * section.length;
    for (int g = 0; g < 2; ++g) {
      const double share = point_share(a, b, g);
      const CrossSection here = section_at(section, share);
      element.stiffness[at(g)] = {here.shear,     here.shear,     here.stretch,
                                  here.bending_x, here.bending_y, here.torsion};
      std::array<double, strain::max_modes> values{};
      legendre(2 * (share - from) / (to - from) - 1, most_modes_, 1 / std::sqrt((to - from) * section.length),
               values);
      for (int k = 0; k < most_modes_; ++k)
        element.modes[at(g)][at(element.stretch * most_modes_ + k)] = values[at(k)];
    }
    if (section.discs.count == 0 || basis_.model == ArmModel::rod) add_guides(m, a, b, element);
    push(section, element, a, b);
  }
  static double point_share(double a, double b, int g) {
    const double side = (g == 0 ? -1 : 1) / std::sqrt(12.0);
    return a + (b - a) * (0.5 + side);
  }
  Element straight(const ArmSection& section, double a, double b) const {
    Element element;
    element.length = (b - a) * section.length;
    element.commutator = std::sqrt(3.0) / 12 * element.length * element.length;
    element.weight = 0.5 * element.length;
    for (auto& rest : element.rest)
      rest = {0, 0, 1, section.curvature[0], section.curvature[1], section.curvature[2]};
    return element;
  }
  void add_rigid(const ArmSection& section, double a, double b) {
    Element link = straight(section, a, b);
    link.points = 0;
    push(section, link, a, b);
  }
  void add_joint(const ArmSection& section, double place, int joint, double length) {
    Element element;
    element.points = 1;
    element.weight = 1;
    const CrossSection here = section_at(section, place);
    element.stiffness[0] = {0, 0, 0, here.bending_x / length, here.bending_y / length, here.torsion / length};
    element.modes[0][at(joint)] = 1;
    push(section, element, place, place);
  }
  void push(const ArmSection& section, const Element& element, double a, double b) {
    rod_.elements.push_back(element);
    ++rod_.spans.back().elements;
    const double h = element.length;
    const auto mass = [&](double place) { return section_at(section, place).mass; };
    add_shares(rod_.masses, h, {mass(a), mass(0.5 * (a + b)), mass(b)});
    add_shares(rod_.lengths, h, {1, 1, 1});
    rod_.places.push_back(rod_.places.back() + h);
  }
  /// ∫ of a density times the place by trapezoids with their correction by slopes: exact to fourth order.
  /// @param density at both ends and between, where it is a square of the place at most
  static void add_shares(std::vector<strain::NodeShare>& shares, double h,
                         const std::array<double, 3>& density) {
    const auto [first, middle, last] = density;
    const double rise = last - first, bow = 2 * (2 * middle - first - last);
    shares.emplace_back();
    strain::NodeShare &before = shares[shares.size() - 2], &after = shares.back();
    before.amount += h / 2 * first + h / 12 * (rise + bow);
    after.amount += h / 2 * last - h / 12 * (rise - bow);
    before.moment[2] += first * h * h / 12;
    after.moment[2] -= last * h * h / 12;
  }

  void add_guides(int m, double a, double b, Element& element) {
    const ArmSection& section = arm_.sections[at(m)];
    element.first_guide = static_cast<int>(rod_.guides.size());
    for (std::size_t i = 0; i < arm_.tendons.size(); ++i) {
      const ArmTendon& tendon = arm_.tendons[i];
      if (tendon.section() < m) continue;
      Guide guide;
      guide.tendon = static_cast<int>(i);
      for (int g = 0; g < 2; ++g) {
        guide.place[at(g)] = place_of(tendon.routes[at(m)], point_share(a, b, g));
        guide.slope[at(g)] = slope_of(tendon.routes[at(m)], point_share(a, b, g), section.length);
      }
      rod_.guides.push_back(guide);
      ++element.guides;
    }
  }
  /// Where the last joint stands for so much of a channel: there v + u × r + dr/ds times the length is that
  /// of the straight link, and u times the length is the joint's turn.
  void add_joint_guides(int m, double place, double length) {
    Element& joint = rod_.elements.back();
    const ArmSection& section = arm_.sections[at(m)];
    const auto& [ux, uy, uz] = section.curvature;
    joint.first_guide = static_cast<int>(rod_.guides.size());
    for (std::size_t i = 0; i < arm_.tendons.size(); ++i) {
      const ArmTendon& tendon = arm_.tendons[i];
      if (tendon.section() < m) continue;
      const Three r = place_of(tendon.routes[at(m)], place),
                  slope = slope_of(tendon.routes[at(m)], place, section.length);
      Guide guide;
      guide.tendon = static_cast<int>(i);
      guide.place[0] = r;
      guide.slope[0] = {length * (slope[0] - uz * r[1]), length * (slope[1] + uz * r[0]),
                        length * (1 + ux * r[1] - uy * r[0])};
      rod_.guides.push_back(guide);
      ++joint.guides;
    }
  }
  void add_holes(int m, double start, double end) {
    for (std::size_t i = 0; i < arm_.tendons.size(); ++i) {
      const ArmTendon& tendon = arm_.tendons[i];
      if (tendon.section() < m) continue;
      const TendonRoute& route = tendon.routes[at(m)];
      rod_.holes.push_back({static_cast<int>(i), place_of(route, start), place_of(route, end)});
      ++rod_.spans.back().holes;
    }
  }

  const Arm& arm_;
  ArmBasis basis_;
  RodModel rod_;
  double place_ = 0;               ///< where the section at hand begins
  std::vector<double> stretches_;  ///< of the piece at hand: shares where its polynomials begin and end
  int most_modes_ = 1;             ///< of each stretch
};

}  // namespace

CrossSection round_section(const Material& material, double diameter, double hole) {
  const double pi = std::numbers::pi, area = pi / 4 * (diameter * diameter - hole * hole),
               moment = pi / 64 * (std::pow(diameter, 4) - std::pow(hole, 4));
  return {material.young * moment, material.young * moment, 2 * material.shear * moment,
          material.young * area,   material.shear * area,   material.density * area};
}

CrossSection rectangular_section(const Material& material, double along_x, double along_y) {
  const double area = along_x * along_y, longer = std::max(along_x, along_y),
               shorter = std::min(along_x, along_y);
  // de Saint-Venant's series, to full precision
  double series = 0;
  for (int n = 1; n < 60; n += 2)
    series += std::tanh(n * std::numbers::pi * longer / (2 * shorter)) / std::pow(n, 5);
  const double torsion = longer * std::pow(shorter, 3) *
                         (1.0 / 3 - 64 * shorter / (std::pow(std::numbers::pi, 5) * longer) * series);
  return {material.young * along_x * std::pow(along_y, 3) / 12,
          material.young * along_y * std::pow(along_x, 3) / 12,
          material.shear * torsion,
          material.young * area,
          material.shear * area * 5 / 6,
          material.density * area};
}

int elements_of(const ArmBasis& basis) {
  if (basis.elements > 0) return basis.elements;
  if (basis.model != ArmModel::rod && basis.model != ArmModel::subsegment_rod) return 1;
  const auto& by_order = basis.model == ArmModel::rod ? elements_of_section : elements_between_discs;
  const int order = basis.order < 0 ? usual_order(basis.model) : basis.order;
  return std::max(by_order[std::min(at(order), by_order.size() - 1)], order / 2 + 1);
}

std::string basis_misfit(ArmModel model, int order, int elements) {
  const bool has_polynomials = model == ArmModel::rod || model == ArmModel::subsegment_rod;
  if (!has_polynomials || order < 0 || elements <= 0 || order <= most_order(elements)) return "";
  return fmt::format(
      "polynomials of order {} need at least {} elements, found {}: two Gauss points in each have to tell "
      "their "
      "{} coefficients; give more elements, an order up to {}, or leave elements out",
      order, order / 2 + 1, elements, order + 1, most_order(elements));
}

int order_of(const ArmBasis& basis) {
  if (basis.model != ArmModel::rod && basis.model != ArmModel::subsegment_rod)
    return usual_order(basis.model);
  return basis.order < 0 ? std::min(usual_order(basis.model), most_order(elements_of(basis))) : basis.order;
}

strain::RodModel make_rod(const Arm& arm, const ArmBasis& basis, const std::vector<double>& breaks) {
  return Builder(arm, basis).build(breaks);
}

}  // namespace sinew::inline v1
