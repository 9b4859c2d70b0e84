/// Reads robot files, one a line (JSON is YAML), and says of each what `sinew check` says: the codes of what
/// is wrong with it, nothing of a good one. Thousands of them in one process.
#include <iostream>
#include <set>
#include <string>

#include "io/document/parse.hpp"
#include "sinew/session.hpp"

int main() {
  for (std::string line; std::getline(std::cin, line);) {
    std::set<std::string> codes;
    const auto note = [&](const sinew::Errors& errors) {
      for (const sinew::Error& error : errors) codes.insert(error.code);
    };
    if (auto document = sinew::parse_yaml(line, "line"); !document)
      note(document.error());
    else if (auto session = sinew::Session::open(std::move(*document)); !session)
      note(session.error());
    else if (session->answer(R"({"query": "describe"})").find("\"error\":{") != std::string::npos)
      codes.insert("describe");
    for (const std::string& code : codes) std::cout << code << ' ';
    std::cout << '\n';
  }
}
