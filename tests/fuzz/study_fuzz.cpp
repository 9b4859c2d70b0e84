// Study files: read, with the robots they name. They are read from files, so each input is one for a moment.
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <span>

#include "check.hpp"
#include "driver.hpp"
#include "sinew/study/study.hpp"

namespace {

constexpr std::string_view words[] = {"sinew: 1\n",
                                      "title: a\n",
                                      "robot: 3-rfr\n",
                                      "robot: 3pfs-g2\n",
                                      "robot: nottingham-tpcj\n",
                                      "set: {}\n",
                                      "query: ",
                                      "axes:\n",
                                      "derived:\n",
                                      "samples: ",
                                      "random: ",
                                      "uniform: ",
                                      "normal: ",
                                      "seed: ",
                                      "path: false\n",
                                      "list: ",
                                      "from: ",
                                      "to: ",
                                      "count: ",
                                      "values: ",
                                      "outputs:\n",
                                      "reduce:\n",
                                      "over: [phi]\n",
                                      "columns:\n",
                                      "min: ",
                                      "max: ",
                                      "mean: ",
                                      "rms: ",
                                      "part",
                                      "fits:\n",
                                      "coefficients: ",
                                      "terms: ",
                                      "is: ",
                                      "$x",
                                      "$y",
                                      "$phi",
                                      "x^2",
                                      "x*y",
                                      "2 x",
                                      "-",
                                      "type_1.count",
                                      "indices.condition",
                                      "~",
                                      "[]",
                                      "{}",
                                      "null",
                                      "10 mm",
                                      "5 deg",
                                      "1e999",
                                      "&a ",
                                      "!t "};

std::filesystem::path file() {
  static const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("sinew-fuzz-" + std::to_string(getpid()) + ".yaml");
  static const int removed = std::atexit([] { std::filesystem::remove(path); });
  return removed == 0 ? path : path;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::filesystem::path path = file();
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  const auto study = sinew::read_study(path.string());
  if (!study) sinew::fuzz::check_errors(study.error());
  return 0;
}

SINEW_FUZZ_MAIN("study", words)
