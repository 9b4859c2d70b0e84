/// What `track` says of curves that were left out.
#include "query/curves.hpp"

#include <gtest/gtest.h>

#include "query/handlers.hpp"
#include "sinew/io/robot_file.hpp"

namespace sinew::test {
namespace curves_test {

EquilibriumCurve curve(CurveEnd end, std::size_t points, int from_point = -1) {
  EquilibriumCurve one;
  one.end = end;
  one.points.resize(points);
  one.points.back().event = CurveEvent::target;
  one.from_curve = from_point < 0 ? -1 : 0;
  one.from_point = from_point;
  return one;
}

/// Rows enough for that take half a minute to compute: these are made by hand.
TEST(CurvesOfAnswers, SayThatOthersWereNotFollowed) {
  const Robot robot = load("3pfs-g2").value();
  Workspace work(robot);
  const Document document{"query", {}};
  Errors errors;
  Reader reader(document, errors);
  Value answer = Value::map();
  const Handlers handlers{};
  Question question{reader, errors, answer, handlers, Ask::track};
  Context context{question, robot, work};
  const auto nothing_more = [](const CurvePoint&) { return Value::map(); };
  std::vector<EquilibriumCurve> curves{curve(CurveEnd::left_range, 20), curve(CurveEnd::far, 30, 3)};
  put_curves(context, curves, nothing_more);
  EXPECT_EQ(answer.text_at("message"), "");
  curves.push_back(curve(CurveEnd::not_followed, 1, 5));
  curves.push_back(curve(CurveEnd::not_followed, 1, 7));
  put_curves(context, curves, nothing_more);
  EXPECT_EQ(answer.text_at("message"),
            "curves that leave 2 of the bifurcations were not all followed: the others have 50 rows; ask for "
            "fewer samples or a narrower range");
  EXPECT_EQ(answer.text_at("status"), "converged");  // that of the first curve
}

}  // namespace curves_test
}  // namespace sinew::test
