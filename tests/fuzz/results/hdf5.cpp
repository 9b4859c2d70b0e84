// Damaged HDF5: a table or named errors, whatever the file says of itself.
#include <filesystem>
#include <fstream>
#include <iterator>

#include "fuzz.hpp"
#include "sinew/study/study.hpp"
#include "sinew/study/sweep.hpp"

namespace {

std::string swept(const std::filesystem::path& folder, int compression) {
  const auto study = folder / "study.yaml", result = folder / "result.h5";
  std::ofstream(study)
      << "sinew: 1\nrobot: 3-frr\nquery: {query: inverse, pose: {x: $x, y: $y, phi: 0.1}}\naxes:\n"
         "  y: {from: -120 mm, to: 120 mm, count: 5}\n  x: {from: -120 mm, to: 120 mm, count: 6}\n";
  auto read = sinew::read_study(study);
  if (!read || !sinew::sweep(std::move(*read), {.output = result, .threads = 1, .compression = compression}))
    std::abort();
  std::ifstream file(result, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

int main() {
  using namespace sinew;
  std::string name = (std::filesystem::temp_directory_path() / "sinew-fuzz-XXXXXX").string();
  if (!mkdtemp(name.data())) return 1;
  const std::filesystem::path folder = name, path = folder / "input.h5";
  const std::vector<std::string> corpus{swept(folder, 0), swept(folder, 9)};
  const int exit = fuzz::run("hdf5", corpus, {"OHDR", "TREE", "\x89HDF\r\n\x1a\n", std::string(8, '\xff')},
                             std::size_t{2} << 30U, [&](const std::string& text) {
                               std::ofstream(path, std::ios::binary) << text;
                               const auto table = read_hdf5(path);
                               if (!table)
                                 return !table.error().empty() && !table.error().front().code.empty();
                               for (const Column& column : table->columns)
                                 if (column.values.size() != table->row_count()) return false;
                               return true;
                             });
  std::filesystem::remove_all(folder);
  return exit;
}
