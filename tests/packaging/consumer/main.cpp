// A small program of a user: nothing here knows how sinew was built or where it is.
#include <cmath>
#include <iostream>
#include <string>

#include "sinew/base/error.hpp"
#include "sinew/base/units.hpp"
#include "sinew/link/arc.hpp"

int main() {
  if (std::string(sinew::version()) != SINEW_VERSION_STRING) {
    std::cerr << "headers " SINEW_VERSION_STRING " with library " << sinew::version() << '\n';
    return 1;
  }
  const sinew::Expected<double> length =
      sinew::failure("out_of_range", "robot.yaml:14:11", "length must be positive");
  if (length || sinew::to_string(length.error()).find("robot.yaml:14:11") == std::string::npos) return 1;
  if (sinew::Range::positive().contains(0.0)) return 1;

  const sinew::Arc straight{.length = 0.2};
  if (std::abs(straight.chord(0.0) - 0.2) > 1e-15) return 1;

  std::cout << "sinew " << sinew::version() << '\n';
  return 0;
}
