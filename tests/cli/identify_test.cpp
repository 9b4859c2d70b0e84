// identify: what the command finds is what the library finds; files in, files out.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "command.hpp"
#include "measured_arms.hpp"
#include "sinew/io/robot_file.hpp"

namespace identify_command_test {

using namespace sinew;
using namespace sinew::test;
using Json = nlohmann::json;

const std::string measured_rows = std::string(source_folder) + "/data/measured/ftdcr-v4.csv";

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = a.size() == b.size() ? 0 : 1e9;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

TEST(Identify, FindsWhatTheLibraryFinds) {
  const Scratch here;
  const Outcome outcome = run_command({"identify", "ftdcr-v4", measured_rows, "--hold-out", "0", "-o",
                                       "fitted.yaml", "--errors", "errors.csv", "--json"},
                                      here.path());
  ASSERT_EQ(outcome.exit, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  const Json answer = Json::parse(outcome.out);
  const Recording read = recording("ftdcr-v4");
  const MeasuredArm start = measured_arm("ftdcr-v4");
  const auto parameters = fit_parameters(start, measured_names).value();
  const Identified found = identify(start, parameters, read.rows).value();
  EXPECT_LT(found.train.rms, 4e-3);
  EXPECT_EQ(answer.at("status"), "converged");
  EXPECT_EQ(answer.at("iterations"), found.report.iterations);
  EXPECT_EQ(answer.at("rows"), 810);
  EXPECT_EQ(answer.at("blocks"), 66);
  EXPECT_EQ(answer["errors"].at("fitted").at("rms"), found.train.rms);
  EXPECT_EQ(answer["errors"].at("before").at("max"), found.before.max);
  EXPECT_FALSE(answer["errors"].contains("held_out"));
  ASSERT_EQ(answer.at("parameters").size(), parameters.size());
  ASSERT_EQ(answer.at("covariance").size(), parameters.size());
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    const Json& one = answer["parameters"][p];
    EXPECT_EQ(one.at("name"), parameters[p].name);
    EXPECT_EQ(one.at("unit"), parameters[p].unit);
    EXPECT_EQ(one.at("start"), found.parameters[p].start);
    EXPECT_EQ(one.at("value"), found.parameters[p].value);
    EXPECT_EQ(one.at("deviation"), found.parameters[p].deviation);
    EXPECT_EQ(one.at("prior_share"), found.parameters[p].prior_share);
    const auto k = static_cast<Eigen::Index>(p);
    EXPECT_EQ(answer["covariance"][p][p], found.covariance(k, k));
  }
  EXPECT_EQ(answer.at("flat").size(), found.flat.size());

  // the file is the arm that was found, and shows the same
  const Robot fitted = load((here.path() / "fitted.yaml").string()).value();
  const MeasuredArm again = measured(*fitted.arm());
  EXPECT_EQ(again.marker, found.arm.marker);
  EXPECT_EQ(again.drive, found.arm.drive);
  const auto computed = predict_markers(found.arm, read.rows).value();
  EXPECT_LT(largest_difference(predict_markers(again, read.rows).value(), computed), 1e-9);

  const Table errors = read_csv(here.path() / "errors.csv").value();
  ASSERT_EQ(errors.row_count(), 810U);
  EXPECT_EQ(errors.find("error")->values, found.errors);
  EXPECT_EQ(errors.find("block")->values[809], read.rows.blocks[809]);
  std::vector<double> distances;
  for (std::size_t k = 0; k < 810; ++k) {
    double square = 0;
    for (const char* axis : {"x", "y", "z"})
      square +=
          std::pow(errors.find(axis)->values[k] - errors.find(std::string("computed_") + axis)->values[k], 2);
    distances.push_back(std::sqrt(square));
  }
  EXPECT_LT(largest_difference(distances, found.errors), 1e-5);
}

/// Questions to an arm leave aside how it is measured.
TEST(Identify, WhatIsMeasuredChangesNoAnswer) {
  const Scratch here;
  const std::vector<std::string> asked{"forward", "ftdcr-v4", "--changes", "-1 mm, 0, 0; 0, 0, 0; 0, 0, 0",
                                       "--json"};
  std::vector<std::string> other = asked;
  for (const char* change : {"measurement.drive.toe=3 mm", "measurement.drive.gain=1.5",
                             "measurement.marker.place=[1 mm, 2 mm, 3 mm]"})
    other.insert(other.end(), {"--set", change});
  const Outcome one = run_command(asked, here.path());
  EXPECT_EQ(one.exit, 0) << one.err;
  EXPECT_EQ(one.out, run_command(other, here.path()).out);
}

TEST(Identify, ReplacesItsOwnStart) {
  const Scratch here;
  write_text(here.path() / "rows.csv", read_text(measured_rows));
  const std::vector<std::string> fit{
      "identify",   "ftdcr-v4", "rows.csv", "--fit",       "bending,marker,base,gravity",
      "--hold-out", "0",        "-o",       "fitted.yaml", "--json"};
  const Outcome first = run_command(fit, here.path());
  ASSERT_EQ(first.exit, 0) << first.err;
  std::vector<std::string> again = fit;
  again[1] = "fitted.yaml";
  const Outcome second = run_command(again, here.path());
  ASSERT_EQ(second.exit, 0) << second.err;
  const Json before = Json::parse(first.out), after = Json::parse(second.out);
  EXPECT_NEAR(after["errors"]["before"]["rms"].get<double>(), before["errors"]["fitted"]["rms"].get<double>(),
              1e-6);
  EXPECT_LE(after["errors"]["fitted"]["rms"].get<double>(),
            1.01 * before["errors"]["fitted"]["rms"].get<double>());
}

TEST(Identify, SaysWhereFilesCannotBeWritten) {
  const Scratch here;
  write_text(here.path() / "taken", "");
  const Outcome outcome = run_command(
      {"identify", "ftdcr-v4", measured_rows, "--fit", "lag", "--hold-out", "0", "-o", "taken/fitted.yaml"},
      here.path());
  EXPECT_EQ(outcome.exit, 4) << outcome.err;
  EXPECT_NE(outcome.err.find("file_unwritable"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.out.find("converged"), std::string::npos);  // what was waited for is not lost
}

}  // namespace identify_command_test
