#include "study_items.hpp"

#include <algorithm>

namespace sinew::cli {

std::vector<StudyItem> all_items() {
  const auto items = study_items();
  std::vector<StudyItem> all(items.begin(), items.end());
  all.insert(std::ranges::find(all, "lsk/numbers", &StudyItem::id), insertion_item);
  return all;
}

Expected<Reproduction> reproduce_item(std::string_view id, const std::filesystem::path& out,
                                      const FigureOptions& page) {
  if (id != insertion_item.id) return reproduce(id, out, page);
  const auto made = insertion_result();
  if (!made) return tl::unexpected(made.error());
  return write_item(insertion_item, *made, out / "lsk", page);
}

}  // namespace sinew::cli
