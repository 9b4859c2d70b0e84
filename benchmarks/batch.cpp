/// Questions put through sinew.h, beside the typed functions that solve them: rows of a batch, one row by
/// itself, a million rows on two threads, and questions in JSON. What is over is what the way in costs.
/// Run: build/dev/bin/bench_batch
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <numbers>

#include "report.hpp"
#include "sinew.h"
#include "sinew/analysis/velocity.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/kinematics/equilibrium.hpp"
#include "sinew/kinematics/inverse.hpp"

namespace sinew::bench {
namespace {

/// Rows of three numbers on a closed walk about their middle, neighbours near each other.
std::vector<double> walk(std::size_t rows, std::array<double, 3> middle, std::array<double, 3> reach) {
  std::vector<double> numbers;
  for (std::size_t k = 0; k < rows; ++k)
    for (std::size_t c = 0; c < 3; ++c)
      numbers.push_back(middle[c] +
                        reach[c] * std::sin(2 * std::numbers::pi * static_cast<double>((c + 1) * k) / 2048));
  return numbers;
}
std::vector<double> lengths(std::size_t rows) { return walk(rows, {0.43, 0.43, 0.43}, {0.03, 0.03, 0.03}); }
std::vector<double> planar_poses(std::size_t rows) { return walk(rows, {0, -0.01, 0}, {0.015, 0.015, 0.1}); }

struct Release {
  void operator()(void* object) const { sinew_release(object); }
};
std::unique_ptr<sinew_robot, Release> opened(const char* name) {
  sinew_robot* robot = nullptr;
  sinew_open(name, std::strlen(name), SINEW_FILE, &robot, nullptr);
  return std::unique_ptr<sinew_robot, Release>(robot);
}

/// A question prepared, with three numbers a row that go in and what comes out.
struct Columns {
  std::unique_ptr<sinew_batch, Release> batch;
  std::vector<double> in, out;
  std::vector<std::uint8_t> statuses;
  std::vector<sinew_input> from;
  std::vector<sinew_output> to;
  std::size_t at = 0;

  Columns(const char* robot, const char* question, std::vector<double> numbers, bool is_one_field,
          const std::vector<std::size_t>& outputs)
      : in(std::move(numbers)),
        statuses(in.size() / 3) {
    sinew_batch* prepared = nullptr;
    sinew_prepare(opened(robot).get(), question, std::strlen(question), &prepared, nullptr);
    batch.reset(prepared);
    constexpr std::ptrdiff_t step = sizeof(double);
    for (std::size_t c = 0; c < (is_one_field ? 1U : 3U); ++c)
      from.push_back({in.data() + c, 3 * step, step});
    std::size_t width = 0;
    for (const std::size_t size : outputs) width += size;
    out.resize(width * statuses.size());
    std::size_t before = 0;
    for (const std::size_t size : outputs) {
      to.push_back({out.data() + before, static_cast<std::ptrdiff_t>(width) * step, step});
      before += size;
    }
  }
  void run(std::int32_t threads) {
    sinew_run(batch.get(), statuses.size(), from.data(), to.data(), statuses.data(), threads, nullptr);
  }
  /// One row after the other, each by itself.
  void run_next() {
    at = (at + 1) % statuses.size();
    std::vector<sinew_input>& here = from;
    const auto shift = static_cast<std::ptrdiff_t>(3 * at);
    std::array<sinew_input, 3> row{};
    for (std::size_t c = 0; c < here.size(); ++c) row[c] = {here[c].data + shift, 24, 8};
    sinew_run(batch.get(), 1, row.data(), to.data(), statuses.data() + at, 1, nullptr);
  }
  std::string told() const {
    return fmt::format("{} of {} solved", std::ranges::count(statuses, 7), statuses.size());
  }
};

constexpr const char* rods_question = R"({"query": "forward", "inputs": "$L", "path": "continue"})";
constexpr const char* poses_question =
    R"({"query": "inverse", "pose": {"x": "$x", "y": "$y", "phi": "$phi"}})";

constexpr const char* chains_question = R"({"query": "forward", "model": "prb", "inputs": "$L"})";

std::vector<double> tendons(std::size_t rows) { return walk(rows, {0.19, 0.19, 0.19}, {3e-3, 3e-3, 3e-3}); }

std::shared_ptr<Columns> chains(std::size_t rows) {
  return std::make_shared<Columns>("3-rfr", chains_question, tendons(rows), true,
                                   std::vector<std::size_t>{1, 1, 1, 1});
}
std::shared_ptr<Columns> rods(std::size_t rows) {
  return std::make_shared<Columns>("3pfs-g2", rods_question, lengths(rows), true,
                                   std::vector<std::size_t>{3, 4, 1});
}
std::shared_ptr<Columns> poses(std::size_t rows) {
  return std::make_shared<Columns>("3-rfr", poses_question, planar_poses(rows), false,
                                   std::vector<std::size_t>{3, 1});
}

struct TypedRods {
  Robot robot = load("3pfs-g2").value();
  Workspace work{robot};
  std::vector<double> in;
  std::vector<SpatialPose> out;
  std::vector<double> residuals;
  std::vector<Status> statuses;
  std::size_t at = 0;

  explicit TypedRods(std::size_t rows) : in(lengths(rows)), out(rows), residuals(rows), statuses(rows) {}
  void run() { solve(0, out.size()); }
  void run_next() {
    at = (at + 1) % out.size();
    solve(at, 1);
  }

 private:
  void solve(std::size_t first, std::size_t count) {
    equilibrium_batch(robot, std::span(in).subspan(3 * first, 3 * count), SpatialWrench::Zero(),
                      std::span(out).subspan(first, count), std::span(statuses).subspan(first, count), work,
                      true, std::span(residuals).subspan(first, count));
  }
};

/// One equilibrium of pseudo-rigid chains after the other, each from home.
struct TypedChains {
  Robot robot = load("3-rfr")->as(Model::prb).value();
  Workspace work{robot};
  std::vector<double> in;

  explicit TypedChains(std::size_t rows) : in(tendons(rows)) {}
  void run() {
    for (std::size_t k = 0; k < in.size(); k += 3)
      benchmark::DoNotOptimize(equilibrium(robot, Numbers(in).subspan(k, 3), {}, work).report.status);
  }
};

struct TypedPoses {
  Robot robot = load("3-rfr").value();
  Workspace work{robot};
  std::vector<double> in, out, residuals;
  std::vector<Status> statuses;
  std::size_t at = 0;

  explicit TypedPoses(std::size_t rows) : out(3 * rows), residuals(rows), statuses(rows) {
    const std::vector<double> rowwise = planar_poses(rows);
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t k = 0; k < rows; ++k) in.push_back(rowwise[3 * k + c]);
  }
  void run() {
    velocity_batch(robot, {in}, {.status = statuses, .inputs = out, .residual = residuals}, work);
  }
  /// @param scalar by `inverse`, else as a batch of one
  void run_next(bool scalar) {
    const std::size_t n = statuses.size();
    at = (at + 1) % n;
    const std::array<double, 3> pose{in[at], in[n + at], in[2 * n + at]};
    if (scalar)
      benchmark::DoNotOptimize(inverse(robot, PlanarPose{pose[0], pose[1], pose[2]}, {}, work).report.status);
    else
      velocity_batch(robot, {pose},
                     {.status = std::span(statuses).first(1),
                      .inputs = std::span(out).first(3),
                      .residual = std::span(residuals).first(1)},
                     work);
  }
};

void compare_rows() {
  constexpr std::size_t many = 1'000'000, rows = 1U << 16U;
  auto ours = rods(many);
  auto typed = std::make_shared<TypedRods>(many);
  ours->run(1);
  compare({"3pfs forward, a row of 1e6",
           "typed batch",
           [ours] { ours->run(1); },
           [typed] { typed->run(); },
           ours->told(),
           many,
           {},
           many});
  compare({"3pfs forward, a row of 1e6, two threads",
           "one thread",
           [ours] { ours->run(2); },
           [ours] { ours->run(1); },
           ours->told(),
           many,
           {},
           many,
           true});
  auto in_plane = poses(rows);
  auto typed_poses = std::make_shared<TypedPoses>(rows);
  in_plane->run(1);
  compare({"3-rfr inverse, a row of 65536",
           "typed batch",
           [in_plane] { in_plane->run(1); },
           [typed_poses] { typed_poses->run(); },
           in_plane->told(),
           rows,
           {},
           rows});
}

/// No plan computes these in any other way than question by question: what that costs beyond the solve.
void compare_asked_rows() {
  constexpr std::size_t rows = 512;
  auto ours = chains(rows);
  auto typed = std::make_shared<TypedChains>(rows);
  ours->run(1);
  compare({"3-rfr prb forward, a row of 512",
           "typed, one after the other",
           [ours] { ours->run(1); },
           [typed] { typed->run(); },
           ours->told(),
           rows,
           {},
           rows});
}

void compare_single_rows() {
  constexpr std::size_t rows = 2048;
  auto ours = rods(rows);
  auto typed = std::make_shared<TypedRods>(rows);
  compare({"3pfs forward, one row", "typed batch of one", [ours] { ours->run_next(); },
           [typed] { typed->run_next(); }, "from home"});
  auto in_plane = poses(rows);
  auto typed_poses = std::make_shared<TypedPoses>(rows);
  compare({"3-rfr inverse, one row", "typed batch of one", [in_plane] { in_plane->run_next(); },
           [typed_poses] { typed_poses->run_next(false); }, "closed form"});
}

/// Questions in JSON on a walk, one by one.
struct Asked {
  std::unique_ptr<sinew_session, Release> session;
  std::vector<std::string> questions;
  std::size_t at = 0;

  Asked(const char* robot, std::vector<std::string> all)
      : session(sinew_session_new(opened(robot).get())),
        questions(std::move(all)) {}
  void next() {
    const std::string& question = questions[at = (at + 1) % questions.size()];
    char* answer = sinew_ask(session.get(), question.data(), question.size(), nullptr);
    benchmark::DoNotOptimize(*answer);
    sinew_free(answer);
  }
};

void compare_questions() {
  constexpr std::size_t rows = 2048;
  std::vector<std::string> inverse_questions, forward_questions, pose_questions;
  const std::vector<double> poses = planar_poses(rows), inputs = lengths(rows);
  for (std::size_t k = 0; k < 3 * rows; k += 3) {
    inverse_questions.push_back(fmt::format(R"({{"query":"inverse","pose":{{"x":{},"y":{},"phi":{}}}}})",
                                            poses[k], poses[k + 1], poses[k + 2]));
    forward_questions.push_back(fmt::format(R"({{"query":"forward","inputs":[{},{},{}],"start":"last"}})",
                                            inputs[k], inputs[k + 1], inputs[k + 2]));
    pose_questions.push_back(forward_questions.back());
    pose_questions.back().insert(1, R"("want":["pose"],)");
  }
  auto in_plane = std::make_shared<Asked>("3-rfr", inverse_questions);
  auto typed_poses = std::make_shared<TypedPoses>(rows);
  compare({"3-rfr inverse, asked", "typed inverse", [in_plane] { in_plane->next(); },
           [typed_poses] { typed_poses->run_next(true); }, "JSON in and out"});
  auto forward = std::make_shared<Asked>("3pfs-g2", forward_questions);
  auto robot = std::make_shared<Robot>(load("3pfs-g2").value());
  auto work = std::make_shared<Workspace>(*robot);
  auto warm = [robot, work, inputs, k = std::size_t{0}]() mutable {
    k = (k + 3) % inputs.size();
    benchmark::DoNotOptimize(
        equilibrium(*robot, Numbers(inputs).subspan(k, 3), {.warm_start = true}, *work).report.status);
  };
  warm();
  compare({"3pfs forward from the last answer, asked", "typed warm equilibrium",
           [forward] { forward->next(); }, warm, "JSON in and out"});
  auto pose = std::make_shared<Asked>("3pfs-g2", pose_questions);
  compare({"the same, of the pose alone", "typed warm equilibrium", [pose] { pose->next(); }, warm,
           "JSON in and out"});
}

}  // namespace
}  // namespace sinew::bench

int main(int argc, char** argv) {
  using namespace sinew::bench;
  compare_rows();
  compare_asked_rows();
  compare_single_rows();
  compare_questions();
  return sinew::bench::main(argc, argv);
}
