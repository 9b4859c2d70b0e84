/// @file batch.hpp
/// Many configurations at once. Any question put at many rows of numbers, on as many threads as there are:
/// what the C interface puts its columns through; studies compute their samples alike. The fields of
/// questions: docs/protocol.md. Beside it the typed batches, in vector lanes where the robot has them.
#pragma once
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "sinew/analysis/velocity.hpp"  // IWYU pragma: export
#include "sinew/base/error.hpp"
#include "sinew/io/node.hpp"
#include "sinew/kinematics/equilibrium.hpp"  // IWYU pragma: export
#include "sinew/kinematics/serial.hpp"       // IWYU pragma: export

namespace sinew::inline v1 {

/// Constant once prepared: any number of threads may run it.
class SINEW_API Batch {
 public:
  /// What goes in or comes out of every row: a number, or an array of numbers.
  struct Field {
    std::string name;
    std::string unit;  ///< SI; empty for plain numbers; where those of an array differ as of `sinew_fields`
    std::vector<std::size_t> shape;  ///< empty of a single number

    std::size_t size() const;  ///< numbers of a row
  };
  /// A field of all rows as it lies in memory.
  template <class Number>
  struct Strided {
    Number* data = nullptr;
    std::ptrdiff_t stride = sizeof(double);  ///< bytes from row to row
    std::ptrdiff_t step = sizeof(double);    ///< bytes from number to number of a row, last index fastest

    Number& operator()(std::size_t row, std::size_t number = 0) const {
      using Byte = std::conditional_t<std::is_const_v<Number>, const char, char>;
      return *reinterpret_cast<Number*>(reinterpret_cast<Byte*>(data) +
                                        static_cast<std::ptrdiff_t>(row) * stride +
                                        static_cast<std::ptrdiff_t>(number) * step);
    }
  };

  /// @param robot a robot file's document
  /// @param question a query in which texts `$name` stand for numbers, or for whole lists whose length the
  ///     robot knows (`inputs: $lengths`), and which may have `outputs: {name: place in the answer}`
  ///     (`pose.position`, `J`, `pose.position[2]`, `type_1.count`), left out the usual ones of the question
  ///     and those that the words of its `want` give, and `path: continue` (each row begins where the one
  ///     before ended) or `anew`, the default
  /// Errors: those of robot files; `no_inputs`, `ambiguous` where a name stands for different things,
  /// `unknown_path` where no answer has such an output; `no_effect` where what is wanted is no column; and
  /// the error that a session would answer to every row, whatever its numbers are. That the robot has no
  /// answer (`unsupported`) rows say.
  static Expected<Batch> prepare(const Document& robot, const Document& question);

  std::span<const Field> inputs() const;   ///< in the order in which they stand in the question
  std::span<const Field> outputs() const;  ///< in the order of the question
  /// Words of `want` that rows are asked with: those of the question, and those that its outputs go with.
  std::vector<std::string_view> wants() const;
  /// How rows are computed: `rods in lanes`, `poses in lanes`, `query by query`, ...
  std::string_view method() const;

  struct Options {
    int threads = 0;  ///< 0: as many as there are cores
    /// Set by another thread: rows not computed then have the status `stopped`.
    const std::atomic<bool>* stop = nullptr;
  };
  static constexpr std::uint8_t failed =
      255;  ///< status of a row at which the library failed; please report it
  /// What a row has no value of is NaN. Statuses are those of Report, in their numbers; of a row
  /// whose numbers the question does not take `bad_input`, see `answer`. Rows are cut into chunks by their
  /// number alone: the same bytes for any number of threads. Allocates a chunk's memory for each
  /// thread, which later runs find; throws what that throws. Nothing happens where there are more or fewer
  /// fields than those above, or statuses than rows.
  /// @param statuses one a row, or none
  void run(std::size_t rows, std::span<const Strided<const double>> inputs,
           std::span<const Strided<double>> outputs, std::span<std::uint8_t> statuses,
           const Options& options) const;

  /// The answer to one row by itself, in JSON: what is wrong with it, and all that is no field.
  /// @param inputs numbers of all fields, one after the other
  std::string answer(std::span<const double> inputs) const;

 private:
  struct State;
  explicit Batch(std::shared_ptr<const State> state);
  std::shared_ptr<const State> state_;
};

}  // namespace sinew::inline v1
