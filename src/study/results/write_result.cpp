#include "sinew/study/study.hpp"
#include "study/results/result_file.hpp"

namespace sinew::inline v1 {

Expected<void> write_result(const Table& table, const std::filesystem::path& path) {
  ResultLayout layout;
  layout.rows = table.row_count();
  std::vector<double> values;
  for (const Column& column : table.columns) {
    layout.columns.push_back({column.name, column.unit});
    values.insert(values.end(), column.values.begin(), column.values.end());
  }
  for (std::size_t i = 0; i < table.comments.size(); ++i) {
    const std::string& comment = table.comments[i];
    const std::size_t colon = comment.find(": ");
    if (i == 0)
      layout.title = comment;
    else if (colon != std::string::npos)
      layout.provenance.push_back({comment.substr(0, colon), comment.substr(colon + 2)});
  }
  auto file = create_result(path, std::move(layout));
  if (!file) return tl::unexpected(file.error());
  if (auto written = (*file)->write(
          {.first = 0, .count = table.row_count(), .axes = {}, .columns = values, .statuses = {}});
      !written)
    return written;
  return (*file)->finish({});
}

}  // namespace sinew::inline v1
