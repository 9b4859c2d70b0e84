#include "kinematics/arms/published.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "base/at.hpp"
#include "base/limits.hpp"
#include "math/linalg.hpp"
#include "strain/norm.hpp"

namespace sinew::inline v1 {
namespace {

using strain::Element;
using strain::LoadedRod;
using strain::NodeLoad;
using strain::norm;
using strain::RodFrame;
using strain::RodModel;
using strain::RodWork;
using strain::Span;

using Matrix3 = Mat<double, 3, 3>;

Vec3<double> vec(const double* x) { return {x[0], x[1], x[2]}; }
Matrix3 mat(const double* a) {
  Matrix3 m;
  m << a[0], a[1], a[2], a[3], a[4], a[5], a[6], a[7], a[8];
  return m;
}
Vec3<double> turned(const RodFrame& frame, const Vec3<double>& x) { return mat(frame.R) * x; }

/// A disc and the rod before it.
struct Disc {
  int start = 0, node = 0;  ///< nodes of the disc before it and of its own
  int span = 0;             ///< between them, less the joint at the disc if there is one
  int ends = -1;            ///< the section that ends at it; -1: none
};

std::vector<Disc> discs_of(const Arm& arm, const RodModel& model) {
  std::vector<Disc> discs;
  int section = 0, count = 0;
  for (int s = 0; s < static_cast<int>(model.spans.size()); ++s) {
    const Span& span = model.spans[at(s)];
    const int node = span.first_element + span.elements;
    if (span.elements == 1 && model.elements[at(span.first_element)].points == 1) {  // twists at the disc
      discs.back().node = node;
      continue;
    }
    Disc disc{span.first_element, node, s, -1};
    if (++count == arm.sections[at(section)].discs.count) {
      disc.ends = section++;
      count = 0;
    }
    discs.push_back(disc);
  }
  return discs;
}

/// The rod under its loads and the projected forces of its tendons.
class ProjectedRod {
 public:
  ProjectedRod(const Arm& arm, const ArmOptions& options, LoadedRod& rod)
      : arm_(arm),
        model_(rod.model()),
        rod_(rod),
        work_(rod.work()),
        prb_(options.model == ArmModel::prb),
        collocated_(options.balance == ArmBalance::collocated),
        loads_(work_.loads),
        discs_(discs_of(arm, model_)) {}

  /// Where its coordinates are.
  void evaluate(std::span<double> residual) {
    for (double& tension : work_.hole_tension) tension = 0;
    sweep_out(model_, work_);
    work_.loads = loads_;
    for (double& length : work_.lengths) length = 0;
    for (const Disc& disc : discs_) add_tendons(disc);
    if (!collocated_) {
      sweep_back(model_, work_);
      const double scale = 1 / std::sqrt(model_.energy_scale);
      for (std::size_t i = 0; i < residual.size(); ++i) residual[i] = scale * work_.gradient[i];
      return;
    }
    double* out = residual.data();
    force_.setZero();
    moment_.setZero();
    reached_ = model_.nodes();
    for (std::size_t k = discs_.size(); k-- > 0;) {
      double* own = out + model_.pieces[2 * k].first;
      if (prb_)
        balance_joints(discs_[k], own);
      else
        balance_arc(discs_[k], own);
    }
    for (double& x : residual) x /= model_.energy_scale;
  }

  /// Leaves the rod with the loads that it came with.
  void finish() {
    const std::vector<double> lengths = work_.lengths;
    work_.loads = loads_;
    rod_.evaluate();
    work_.lengths = lengths;
  }

 private:
  void add_tendons(const Disc& disc) {
    const Span& span = model_.spans[at(disc.span)];
    for (int i = span.first_hole; i < span.first_hole + span.holes; ++i) {
      const strain::Hole& hole = model_.holes[at(i)];
      const RodFrame &before = work_.frames[at(disc.start)], &here = work_.frames[at(disc.node)];
      const Vec3<double> a = turned(before, vec(hole.start.data())), b = turned(here, vec(hole.end.data()));
      const Vec3<double> way = vec(before.p) + a - vec(here.p) - b;
      const double length = way.norm();
      work_.lengths[at(hole.tendon)] += length;
      const Vec3<double> pull = way * (rod_.tensions()[at(hole.tendon)] / length);
      const bool ends = disc.ends >= 0 && arm_.tendons[at(hole.tendon)].section() == disc.ends;
      add_force(disc.node, here, b, pull, !ends);
      if (disc.start > 0) add_force(disc.start, before, a, -pull, true);
    }
  }
  void add_force(int node, const RodFrame& frame, const Vec3<double>& arm, Vec3<double> force, bool project) {
    const Vec3<double> normal(frame.R[2], frame.R[5], frame.R[8]);
    if (project) force -= normal * normal.dot(force);
    const Vec3<double> moment = cross(arm, force);
    NodeLoad& load = work_.loads[at(node)];
    for (int i = 0; i < 3; ++i) {
      load.force[i] += force[i];
      load.moment[i] += moment[i];
    }
  }

  /// All that acts on nodes from this one on: a force, and its moment about the base.
  void sum_from(int node) {
    while (reached_ > node) {
      --reached_;
      const NodeLoad& load = work_.loads[at(reached_)];
      const RodFrame& frame = work_.frames[at(reached_)];
      const Vec3<double> force = vec(load.force) + turned(frame, vec(load.following));
      Vec3<double> moment = vec(load.moment) + turned(frame, vec(load.following + 3));
      const Matrix3 E = mat(load.couple) * mat(frame.R).transpose();  // Σ f dᵀ, both in base axes
      moment += Vec3<double>(E(2, 1) - E(1, 2), E(0, 2) - E(2, 0), E(1, 0) - E(0, 1));
      force_ += force;
      moment_ += moment + cross(vec(frame.p), force);
    }
  }
  Vec3<double> moment_about(int node) const { return moment_ - cross(vec(work_.frames[at(node)].p), force_); }
  /// Of what twists at the disc [N m].
  double torque(const Disc& disc) const {
    const Element& joint = model_.elements[at(disc.node - 1)];
    return joint.stiffness[0][5] * (work_.strains[at(disc.node - 1)][0][5] - joint.rest[0][5]);
  }

  /// Bending at the piece's start and torsion at its end against all moments about its start.
  void balance_arc(const Disc& disc, double* out) {
    sum_from(disc.start + 1);
    const Element& element = model_.elements[at(disc.start)];
    const Matrix3 R = mat(work_.frames[at(disc.start)].R), end = mat(work_.frames[at(disc.node)].R);
    Vec3<double> gap = R.transpose() * (end.col(2) * torque(disc) - moment_about(disc.start));
    for (int i = 0; i < 2; ++i) {
      const auto c = static_cast<std::size_t>(i + 3);
      for (std::size_t g = 0; g < 2; ++g)
        gap[i] += 0.5 * element.stiffness[g][c] * (work_.strains[at(disc.start)][g][c] - element.rest[g][c]);
    }
    for (int i = 0; i < 3; ++i) out[i] = gap[i];
  }

  /// Joints turn about the direction in which the moment bends the start of their piece.
  void balance_joints(const Disc& disc, double* out) {
    const int joints = model_.pieces[at(2 * static_cast<int>(&disc - discs_.data()))].modes[3];
    const Matrix3 R = mat(work_.frames[at(disc.start)].R);
    sum_from(disc.node);
    std::array<Vec3<double>, strain::max_modes> moments{};
    int joint = joints;
    for (int e = disc.node - 2; e > disc.start; --e) {
      if (model_.elements[at(e)].points != 1) continue;
      sum_from(e + 1);
      moments[at(--joint)] = R.transpose() * moment_about(e);
    }
    sum_from(disc.start + 1);
    const Vec3<double> base = R.transpose() * moment_about(disc.start);
    const double size = std::hypot(base[0], base[1]);
    const std::array<double, 2> axis =
        size > 0 ? std::array{base[0] / size, base[1] / size} : std::array{1.0, 0.0};
    for (int e = disc.start; e < disc.node - 1; ++e) {
      const Element& element = model_.elements[at(e)];
      if (element.points != 1) continue;
      const double along = axis[0] * moments[at(joint)][0] + axis[1] * moments[at(joint)][1];
      for (std::size_t i = 0; i < 2; ++i)
        out[at(joint) + i * at(joints)] =
            element.stiffness[0][i + 3] * work_.strains[at(e)][0][i + 3] - axis[i] * along;
      ++joint;
    }
    const RodFrame& end = work_.frames[at(disc.node)];
    out[2 * joints] = torque(disc) - Vec3<double>(end.R[2], end.R[5], end.R[8]).dot(moment_about(disc.start));
  }

  const Arm& arm_;
  const RodModel& model_;
  LoadedRod& rod_;
  RodWork& work_;
  bool prb_, collocated_;
  std::vector<NodeLoad> loads_;
  std::vector<Disc> discs_;
  Vec3<double> force_, moment_;
  int reached_ = 0;
};

/// Newton's steps with differences of the residual as derivative, kept while they do; halved where they do
/// not lower it.
strain::Relaxed solve_balance(const strain::RelaxOptions& options, ProjectedRod& rod, std::vector<double>& y,
                              double scale) {
  using Matrix = Eigen::MatrixXd;
  const auto n = static_cast<Eigen::Index>(y.size());
  strain::Relaxed result;
  std::vector<double> residual(y.size()), trial(y.size());
  rod.evaluate(residual);
  ++result.evaluations;
  Matrix J(n, n);
  Eigen::PartialPivLU<Matrix> lu(n);
  bool known = false;
  for (;; ++result.iterations) {
    result.residual = norm(residual);
    if (result.residual <= options.tolerance || must_end(result, options)) return result;
    const bool fresh = !known;
    if (fresh) {
      const double h = 1e-7 * scale;
      for (Eigen::Index j = 0; j < n; ++j) {
        const double before = y[static_cast<std::size_t>(j)];
        y[static_cast<std::size_t>(j)] = before + h;
        rod.evaluate(trial);
        y[static_cast<std::size_t>(j)] = before;
        for (Eigen::Index i = 0; i < n; ++i)
          J(i, j) = (trial[static_cast<std::size_t>(i)] - residual[static_cast<std::size_t>(i)]) / h;
      }
      result.evaluations += static_cast<int>(n);
      lu.compute(J);
      known = true;
    }
    const Eigen::VectorXd step = lu.solve(Eigen::Map<const Eigen::VectorXd>(residual.data(), n));
    const std::vector<double> from = y;
    double share = 1, reduced = 1;
    for (; share > 1e-4; share /= 2) {
      for (Eigen::Index i = 0; i < n; ++i)
        y[static_cast<std::size_t>(i)] = from[static_cast<std::size_t>(i)] - share * step[i];
      rod.evaluate(trial);
      ++result.evaluations;
      reduced = norm(trial) / result.residual;
      if (reduced < 1 - 0.1 * share) break;
    }
    if (share <= 1e-4) {
      y = from;
      rod.evaluate(residual);
      if (fresh) {
        result.status = Status::stalled;
        return result;
      }
      known = false;
      continue;
    }
    std::swap(residual, trial);
    known = reduced < 0.2;
  }
}

/// Of a section: lengths of its tendons are A + x B + y C over their places (x, y), so curvature is
/// (C, −B)/A.
struct Bend {
  double length = 0, by_x = 0, by_y = 0;
  int rank = 0;
};
Bend bend_of(const Arm& arm, int section, std::span<const double> lengths) {
  std::vector<double> rows, sides;
  for (std::size_t i = 0; i < arm.tendons.size(); ++i) {
    if (arm.tendons[i].section() != section) continue;
    const TendonRoute& route = arm.tendons[i].routes[at(section)];
    const double scale = arm.tendons[i].routes[at(section)].start_radius;
    rows.insert(rows.end(), {1 / scale, std::cos(route.start_angle), std::sin(route.start_angle)});
    sides.push_back(lengths[i] / scale);
  }
  if (sides.size() < 3 || sides.size() > max_rows) return {};
  std::array<double, 3> fit{};
  Bend bend;
  // columns of like size: the first by the first tendon's radius
  const double unit = 1 / rows[0];
  for (std::size_t k = 0; k < rows.size(); k += 3) rows[k] *= unit;
  bend.rank = least_norm({rows.data(), static_cast<Eigen::Index>(sides.size()), 3}, sides, fit, 1e-9);
  bend.length = fit[0] * unit;
  bend.by_x = fit[1];
  bend.by_y = fit[2];
  return bend;
}

strain::Relaxed bend_by_lengths(const Arm& arm, std::span<const TendonCommand> commands, LoadedRod& rod) {
  strain::Relaxed result;
  const RodModel& model = rod.model();
  std::vector<double> lengths;  // what is left of each tendon from the section at hand on
  for (std::size_t i = 0; i < arm.tendons.size(); ++i) {
    double length = commands[i].value;
    for (int m = 0; m <= arm.tendons[i].section(); ++m) length += arm.sections[at(m)].length;
    lengths.push_back(length);
  }
  for (int m = 0; m < static_cast<int>(arm.sections.size()); ++m) {
    const Bend bend = bend_of(arm, m, lengths);
    if (!(bend.length > 0)) {
      result.status = Status::left_domain;
      std::ranges::fill(rod.work().y, 0.0);
      break;
    }
    const strain::Piece& piece = model.pieces[at(m)];
    const Element& element = model.elements[at(model.spans[at(piece.first_span)].first_element)];
    const std::array<double, 3> curvature{bend.by_y / bend.length, -bend.by_x / bend.length, 0};
    for (std::size_t c = 3; c < 6; ++c)
      rod.work().y[at(piece.first + piece.offset[c])] =
          (curvature[c - 3] - element.rest[0][c]) / (piece.scale[c] * element.modes[0][0]);
    for (std::size_t i = 0; i < arm.tendons.size(); ++i) {
      if (arm.tendons[i].section() <= m) continue;
      const TendonRoute& route = arm.tendons[i].routes[at(m)];
      lengths[i] -= bend.length + route.start_radius * (bend.by_x * std::cos(route.start_angle) +
                                                        bend.by_y * std::sin(route.start_angle));
    }
  }
  for (strain::TendonHold& hold : rod.holds) hold = {true, 0, 0, 0};
  rod.evaluate();
  return result;
}

}  // namespace

Report fits_balance(const Arm& arm, std::span<const TendonCommand> commands, const ArmLoad& load,
                    const ArmOptions& options) {
  const ArmBalance balance = options.balance;
  if (balance == ArmBalance::energy) return {};
  const auto no = [](Status status, const std::string& words) {
    return Report{status, 0, 0, FixedText<240>(words)};
  };
  const bool closed = balance == ArmBalance::closed_form;
  const ArmModel model = options.model;
  if (closed ? model != ArmModel::cc
             : model == ArmModel::rod || model == ArmModel::cc ||
                   (balance == ArmBalance::collocated && model == ArmModel::subsegment_rod))
    return no(Status::unsupported,
              "this balance is not for this model: projected is for subsegment_rod, subsegment_cc and prb, "
              "collocated for the last two, closed_form for cc");
  for (std::size_t i = 0; i < commands.size(); ++i)
    if ((commands[i].held == TendonHeld::change) != closed)
      return no(Status::unsupported,
                closed
                    ? fmt::format("the closed form needs changes of lengths, tendon {} is held by tension", i)
                    : fmt::format("this balance needs tensions, tendon {} is held by a change of length", i));
  if (!closed) {
    for (std::size_t m = 0; m < arm.sections.size(); ++m)
      if (arm.sections[m].discs.count == 0)
        return no(Status::unsupported, fmt::format("this balance needs discs, section {} has none", m));
    if (model == ArmModel::prb && balance == ArmBalance::collocated && !load.points.empty())
      return no(Status::unsupported, "loads between discs are not for collocated joints");
    return {};
  }
  const auto some = [](std::span<const double> values) {
    return std::ranges::any_of(values, [](double x) { return x != 0; });
  };
  if (some(load.wrench) || some(load.following) || some(load.along) || some(load.following_along) ||
      !load.points.empty())
    return no(Status::unsupported, "the closed form has no loads: lengths of tendons alone bend the arm");
  std::vector<double> lengths(arm.tendons.size(), 1.0);
  for (std::size_t i = 0; i < arm.tendons.size(); ++i)
    for (const TendonRoute& route : arm.tendons[i].routes)
      if (route.start_radius != route.end_radius || route.start_angle != route.end_angle)
        return no(Status::unsupported,
                  fmt::format("the closed form needs parallel tendons, tendon {} is not", i));
  for (int m = 0; m < static_cast<int>(arm.sections.size()); ++m)
    if (bend_of(arm, m, lengths).rank < 3)
      return no(
          Status::unsupported,
          fmt::format("the closed form needs three tendons, not in one plane, that end at section {}", m));
  return {};
}

std::string_view published_words(Status status) {
  switch (status) {
    case Status::stalled:
      return "no step lowers the residual any more";
    case Status::left_domain:
      return "an iterate was not finite, or tendons are shorter than no length";
    case Status::iteration_limit:
      return "the bound on iterations was met";
    case Status::stopped:
      return "stopped";
    default:
      return "";
  }
}

strain::Relaxed relax_published(const Arm& arm, std::span<const TendonCommand> commands,
                                const ArmOptions& options, const strain::RelaxOptions& relax, bool warm,
                                LoadedRod& rod) {
  if (options.balance == ArmBalance::closed_form) return bend_by_lengths(arm, commands, rod);
  int spent = 0;
  if (warm) {
    rod.evaluate();
  } else {
    const strain::Relaxed start = rod.relax(relax);
    if (start.status == Status::stopped || start.status == Status::left_domain) return start;
    spent = start.iterations;
  }
  ProjectedRod projected(arm, options, rod);
  strain::Relaxed found = solve_balance(relax, projected, rod.work().y, std::sqrt(rod.model().energy_scale));
  projected.finish();
  found.iterations += spent;
  return found;
}

}  // namespace sinew::inline v1
