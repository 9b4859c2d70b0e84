/// Reads study files, a path a line, and says of each what `sinew sweep FILE --list` says: the codes of what
/// is wrong with it, nothing of a good one. Hundreds of them in one process.
#include <iostream>
#include <set>
#include <string>

#include "sinew/study/sweep.hpp"

int main() {
  for (std::string path; std::getline(std::cin, path);) {
    std::set<std::string> codes;
    const auto note = [&](const sinew::Errors& errors) {
      for (const sinew::Error& error : errors) codes.insert(error.code);
    };
    if (const auto study = sinew::read_study(path); !study)
      note(study.error());
    else if (const auto columns = sinew::sweep_columns(*study); !columns)
      note(columns.error());
    for (const std::string& code : codes) std::cout << code << ' ';
    std::cout << '\n';
  }
}
