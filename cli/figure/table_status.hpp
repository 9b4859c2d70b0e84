/// @file table_status.hpp
/// How the samples of a sweep ended: what is no solution is not drawn as one.
#pragma once
#include <string>
#include <vector>

#include "sinew/io/table.hpp"

namespace sinew::cli {

/// The words that a table has for its column `status`, of those that occur in it; empty of any other table.
class Statuses {
 public:
  explicit Statuses(const Table& table);

  const std::vector<std::string>& words() const { return words_; }
  bool has_others() const;  ///< than `converged`

  /// Removes the values of samples that did not converge, but where they are: what grid they form, and `x`.
  void leave_out(Table& table, const std::string* x) const;
  /// The column's codes as places in `words()`, so that an axis or a bar of colours can name them.
  void number(Table& table) const;
  /// `1400 of 1520 samples converged; not drawn: 100 unstable, 20 unreachable`; empty where all did.
  std::string remark(bool draws_all) const;

 private:
  std::vector<double> codes_;
  std::vector<std::string> words_;
  std::vector<std::size_t> counts_;
  std::size_t rows_ = 0;
};

}  // namespace sinew::cli
