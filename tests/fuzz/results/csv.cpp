// Damaged CSV: a table whose columns are of one length and that reads back as it was written, or named
// errors.
#include <cmath>

#include "fuzz.hpp"
#include "sinew/io/table.hpp"

int main() {
  using namespace sinew;
  const std::vector<std::string> corpus{
      "# sinew "
      "0.1.0\nk,eta,x[m],phi[rad],condition\n0,0,0,0,14.661461344404344\n59,1,0.03,1.0471975511965976,\n",
      "\xEF\xBB\xBF# c\r\n\r\n x [m] ,\"y\"\r\n 1 , 2e3\r\n\r\n3,\r\n4,5",
      "\"a \"\"name\"\", with a comma[m]\",#c\n1,2\n,\n5e-324,1.7976931348623157e308\n",
      "# status: 0 unreachable, 7 converged\nx[m],v,status\n0,1,7\n1,,0\n",
      "only\n\n1\n\n",
      ""};
  const std::vector<std::string> words{",",
                                       "\n",
                                       "\"",
                                       "\r\n",
                                       "#",
                                       "nan",
                                       "inf",
                                       "-0",
                                       "1e999",
                                       "[",
                                       "]",
                                       "\xff",
                                       std::string(5000, ','),
                                       std::string(1, '\0'),
                                       "\x1b[31m"};
  return fuzz::run("csv", corpus, words, std::size_t{1} << 30U, [](const std::string& text) {
    const auto table = parse_csv(text, "t.csv");
    if (!table) {
      for (const Error& error : table.error())
        if (error.code.empty() || error.where.empty() || error.message.empty()) return false;
      return !table.error().empty() && table.error().size() <= 20;
    }
    for (const Column& column : table->columns)
      if (column.values.size() != table->row_count()) return false;
    const auto again = parse_csv(to_csv(*table), "t.csv");
    return again && again->row_count() == table->row_count() &&
           again->columns.size() == table->columns.size();
  });
}
