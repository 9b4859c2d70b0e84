#include <gtest/gtest.h>

#include <array>

#include "sanitizers.hpp"
#include "study/lsk/cycles/measure.hpp"
#include "study/reproduce.hpp"
#include "study_folder.hpp"

namespace sinew {
namespace lsk_cycles_test {

/// The program of 5 sections, run once. Skipped where there is no cross compiler or simulator.
class Cycles : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    const auto found = lsk::find_cycles_tools();
    if (!found) return;
    tools = *found;
    const test::Folder folder;
    run = lsk::measure_cycles(5, tools, folder.path).value();
  }
  void SetUp() override {
    if (tools.compiler_version.empty()) GTEST_SKIP() << lsk::find_cycles_tools().error()[0].message;
  }
  static const lsk::KernelCycles& of(const char* kernel) { return *run.find(kernel); }

  static lsk::CyclesTools tools;
  static lsk::CyclesRun run;
};
lsk::CyclesTools Cycles::tools;
lsk::CyclesRun Cycles::run;

struct Known {
  const char* kernel;
  double mean;   ///< cycles of avr-g++ 5.4.0
  double error;  ///< [mm], at most
};

/// @verifies LSK (16)
TEST_F(Cycles, AreThoseKnownOfThisCompiler) {
  EXPECT_NE(tools.compiler_version.find("5.4.0"), std::string::npos) << tools.compiler_version;
  for (const Known& known :
       {Known{"pcc_polar_paper_float", 246908, 2e-5}, Known{"pcc_twin_paper_float", 264409, 2e-5},
        Known{"pcc_polar_float", 39666, 5e-6}, Known{"pcc_twin_float", 21621, 2e-6},
        Known{"pcc_twin_q15_16", 33423, 6e-4}, Known{"pcc_twin_int16", 9245, 9e-3},
        Known{"lsk_polar_float", 27518, 4e-6}, Known{"lsk_polar_int16", 9003, 3e-2},
        Known{"lsk_twin_float", 7746, 2e-6}, Known{"lsk_twin_float_sum", 7044, 3e-6},
        Known{"lsk_twin_q15_16", 9107, 3e-5}, Known{"lsk_twin_int16", 2144, 3e-3}}) {
    EXPECT_NEAR(of(known.kernel).mean, known.mean, 0.03 * known.mean) << known.kernel;
    EXPECT_LT(of(known.kernel).error, known.error) << known.kernel;
  }
}

TEST_F(Cycles, DoNotDependOnTheNumbersWhereAnAvrMultiplies) {
  for (const auto& [kernel, cycles] :
       {std::pair{"lsk_twin_int16_mac", 1148L}, {"lsk_twin_int16_mac_sum", 900L}}) {
    EXPECT_EQ(of(kernel).least, cycles);
    EXPECT_EQ(of(kernel).most, cycles);
    EXPECT_EQ(of(kernel).samples, 48);
  }
}

TEST_F(Cycles, GrowWithTheSectionsAsFigure8Claims) {
  if (test::addresses_are_checked)
    GTEST_SKIP() << "a program of another processor, ten times: nothing here for a sanitizer";
  const test::Folder folder;
  const Reproduction made = reproduce("lsk/fig8", folder.path).value();
  int claims = 0;
  for (const Finding& finding : made.findings) {
    if (finding.verdict == "holds") ++claims;
    if (finding.verdict == "fails") {
      EXPECT_EQ(finding.quantity, "its peaks grow exponentially");
    }
  }
  EXPECT_EQ(claims, 6);
  EXPECT_EQ(made.files.size(), 5U);
}

}  // namespace lsk_cycles_test
}  // namespace sinew
