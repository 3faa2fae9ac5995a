#include "experiments/verdict.hpp"

#include "raytruth/core/error.hpp"

#include <gtest/gtest.h>

namespace raytruth {
namespace {

const RowNames names{.columns = {"measure", "field", "scheme", "xi", "xi_radius", "xi_p05", "xi_p95", "status", "why"},
                     .measures = {"signal_error"},
                     .fields = {"white", "bonsai"},
                     .transfers = {},
                     .schemes = {"order1", "order2"}};

const std::vector<Column> columns{{.name = "xi", .unit = "", .description = "", .radius = "xi_radius"}};

Row row(const std::string& field, const std::string& scheme, Value xi) {
  return {{"measure", "signal_error"},
          {"field", field},
          {"scheme", scheme},
          {"xi", std::move(xi)},
          {"xi_radius", 0.001},
          {"xi_p05", 0.1},
          {"xi_p95", 0.4},
          {"status", "ok"},
          {"why", Value()}};
}

const Row refused{{"measure", "signal_error"}, {"field", "bonsai"}, {"status", "refused"}, {"why", "no volume"}};
const std::vector<Row> rows{row("white", "order1", 0.2), row("white", "order2", 0.02), refused};

Verdict judge_text(const std::string& json) {
  return judge(read_claim(JsonReader::from_text(json, "claim.json"), names), rows, columns);
}

CheckOutcome check_text(const std::string& json) {
  return judge(read_check(JsonReader::from_text(json, "check.json"), names), rows);
}

TEST(Claim, FigureMeetsTheMeasuredIntervalOrNot) {
  const auto stated = [](const std::string& figure) {
    return judge_text(R"({"claim": "c", "resolution": 0.01, "row": {"field": "white", "scheme": "order1"},
                          "measured": "xi", "stated": )" +
                      figure + "}");
  };
  EXPECT_EQ(stated("0.2").verdict, "reproduced");
  EXPECT_EQ(stated("0.2059").verdict, "reproduced");
  EXPECT_EQ(stated("0.2061").verdict, "contradicted");
  EXPECT_EQ(stated("0.1941").verdict, "reproduced");
  EXPECT_EQ(stated("0.1939").verdict, "contradicted");
  const Verdict verdict = stated("0.2");
  EXPECT_DOUBLE_EQ(*as_number(verdict.low), 0.199);
  EXPECT_DOUBLE_EQ(*as_number(verdict.high), 0.201);
}

TEST(Claim, FigureAgainstADistribution) {
  const std::string claim = R"({"claim": "c", "stated": 0.4004, "resolution": 0.001, "measured": "xi", "low": "xi_p05",
                                "high": "xi_p95", "why": "spread", "row": {"field": "white", "scheme": "order1"}})";
  const Verdict verdict = judge_text(claim);
  EXPECT_EQ(verdict.verdict, "reproduced");
  EXPECT_EQ(verdict.high, Value(0.4));
  EXPECT_EQ(verdict.why, Value("spread"));
}

TEST(Claim, FigureInAWideDistributionIsCompatible) {
  const auto between = [](const std::string& low, const std::string& kind) {
    return judge_text(R"({"claim": "c", "stated": 0.2, "resolution": 0.001, "measured": "xi", "low": ")" + low +
                      R"(", "high": "xi_p95", "percentile": "xi_p05", "kind": ")" + kind +
                      R"(", "row": {"field": "white", "scheme": "order1"}})");
  };
  // 0.001 to 0.4, and 0.1 to 0.4.
  EXPECT_EQ(between("xi_radius", "claim").verdict, "compatible");
  EXPECT_EQ(between("xi_p05", "claim").verdict, "reproduced");
  EXPECT_EQ(between("xi_radius", "internal consistency").verdict, "consistent");
  EXPECT_EQ(between("xi_p05", "claim").percentile, Value(0.1));
  EXPECT_EQ(between("xi_p05", "claim").range, "xi_p05 to xi_p95");
}

TEST(Claim, OfTwoSidesIsBrokenOnEither) {
  const auto within = [](const std::string& limits) {
    return judge_text(R"({"claim": "c", "stated": "similar", "kind": "finding", "rows": {"measure": "signal_error"},
                          "test": {"column": "xi", )" +
                      limits + "}}");
  };
  EXPECT_EQ(within(R"("at_least": 0.01, "at_most": 0.3)").verdict, "found");
  EXPECT_EQ(within(R"("at_least": 0.1, "at_most": 0.3)").verdict, "not found");
  EXPECT_EQ(within(R"("at_least": 0.1, "at_most": 0.3)").measured, Value(0.02));
  EXPECT_EQ(within(R"("at_least": 0.01, "at_most": 0.1)").measured, Value(0.2));
  EXPECT_THROW(within(R"("at_least": 0.3, "at_most": 0.1)"), InputError);
}

TEST(Claim, TakesTheLimitOfItsCriterion) {
  const auto judged = [](const std::string& criterion) {
    return judge_text(R"({"claim": "c", "stated": "rare", "rows": {"field": "white"}, "test": {"column": "xi"},
                          "criterion": ")" +
                      criterion + R"("})");
  };
  EXPECT_EQ(judged("rare").verdict, "contradicted");  // at most 1e-4
  EXPECT_EQ(judged("many").verdict, "reproduced");    // at least 0.01
  EXPECT_THROW(judged("identity"), InputError);       // has no limit
  EXPECT_THROW(judged("taste"), InputError);          // is none
}

TEST(Claim, ShowsOtherColumnsThanTheOneTested) {
  const Verdict verdict =
      judge_text(R"({"claim": "c", "stated": "rare", "rows": {"field": "white"}, "measured": "xi", "low": "xi_p05",
                     "high": "xi_p95", "test": {"column": "xi_p95", "at_most": 0.1}})");
  EXPECT_EQ(verdict.verdict, "contradicted");
  EXPECT_EQ(verdict.column, "xi");
  EXPECT_EQ(verdict.low, Value(0.1));
  EXPECT_EQ(verdict.high, Value(0.4));
}

TEST(Claim, IsNotComparableWithoutARowOfItsOwn) {
  const auto selecting = [](const std::string& selector) {
    return judge_text(R"({"claim": "c", "stated": 1, "resolution": 1, "measured": "xi", "row": )" + selector + "}");
  };
  EXPECT_EQ(selecting(R"({"field": "bonsai"})").verdict, "not comparable");
  EXPECT_EQ(selecting(R"({"field": "bonsai", "scheme": "order1"})").why, Value("no volume"));
  EXPECT_EQ(selecting(R"({"field": "white"})").verdict, "not comparable");
  EXPECT_EQ(selecting(R"({"field": "white", "xi": 7})").verdict, "not comparable");
  const Verdict elsewhere = judge_text(R"({"claim": "c", "stated": 30, "why": "their hardware"})");
  EXPECT_EQ(elsewhere.verdict, "not comparable");
  EXPECT_EQ(elsewhere.why, Value("their hardware"));
}

TEST(Claim, SentenceIsTestedOnAllRowsThatThereAre) {
  const auto testing = [](const std::string& bound) {
    return judge_text(R"({"claim": "c", "stated": "small", "rows": {"measure": "signal_error"},
                          "test": {"column": "xi", )" +
                      bound + "}}");
  };
  EXPECT_EQ(testing(R"("at_most": 0.2)").verdict, "reproduced");
  EXPECT_EQ(testing(R"("at_most": 0.19)").verdict, "contradicted");
  EXPECT_EQ(testing(R"("at_least": 0.02)").measured, Value(0.02));
  EXPECT_EQ(testing(R"("at_least": 0.03)").verdict, "contradicted");
}

TEST(Claim, IsAnsweredByOtherRowsWhereItsOwnAreAllRefused) {
  const auto asking = [](const std::string& field) {
    return judge_text(R"({"claim": "c", "stated": 0.2, "resolution": 0.1, "measured": "xi", "why": "spread",
                          "row": {"scheme": "order1", "field": ")" +
                      field + R"("}, "otherwise": {"field": "white", "scheme": "order1"}})");
  };
  const Verdict other = asking("bonsai");
  EXPECT_EQ(other.verdict, "reproduced");
  EXPECT_EQ(other.why, Value("all rows of bonsai are refused: these are of white; spread"));
  EXPECT_EQ(asking("white").why, Value("spread"));
  const Verdict sentence =
      judge_text(R"({"claim": "c", "stated": "small", "rows": {"field": "bonsai"}, "otherwise": {"field": "white"},
                     "test": {"column": "xi", "at_most": 0.1}})");
  EXPECT_EQ(sentence.verdict, "contradicted");
  // Rows that there are not at all are an error of the claim, which nothing else answers.
  const Verdict none = judge_text(R"({"claim": "c", "stated": "small", "rows": {"field": "white", "xi": 7},
                                      "otherwise": {"field": "white"}, "test": {"column": "xi", "at_most": 1}})");
  EXPECT_EQ(none.verdict, "not comparable");
}

TEST(Check, IsOfOtherRowsWhereItsOwnAreAllRefused) {
  const CheckOutcome outcome =
      check_text(R"({"bound": "b", "rows": {"field": "bonsai"}, "otherwise": {"field": "white"},
                                              "column": "xi", "at_most": 0.2})");
  EXPECT_TRUE(outcome.holds);
  EXPECT_EQ(outcome.why, Value("all rows of bonsai are refused: these are of white"));
  EXPECT_EQ(check_text(R"({"bound": "b", "rows": {"measure": "signal_error"}, "otherwise": {"field": "white"},
                           "column": "xi", "at_most": 0.2})")
                .why,
            Value());
}

TEST(Check, HoldsOnTheWorstRow) {
  const CheckOutcome outcome =
      check_text(R"({"bound": "b", "rows": {"scheme": ["order1", "order2"]}, "column": "xi", "at_most": 0.2})");
  EXPECT_TRUE(outcome.holds);
  EXPECT_EQ(outcome.measured, Value(0.2));
  EXPECT_FALSE(check_text(R"({"bound": "b", "rows": {"scheme": "order1"}, "column": "xi", "at_most": 0.1})").holds);
}

TEST(Check, DoesNotHoldWhereThereIsNothingToMeasure) {
  const CheckOutcome absent =
      check_text(R"({"bound": "b", "rows": {"field": "bonsai"}, "column": "xi", "at_most": 9})");
  EXPECT_FALSE(absent.holds);
  EXPECT_EQ(absent.why, Value("no volume"));
  const CheckOutcome none =
      check_text(R"({"bound": "b", "rows": {"xi": 3, "status": "ok"}, "column": "xi", "at_most": 9})");
  EXPECT_FALSE(none.holds);
  EXPECT_EQ(none.measured, Value());
  const std::vector<Row> with_null{row("white", "order1", Value())};
  const Check check = read_check(
      JsonReader::from_text(R"({"bound": "b", "rows": {"field": "white"}, "column": "xi", "at_most": 9})", "f"), names);
  EXPECT_FALSE(judge(check, with_null).holds);
}

}  // namespace
}  // namespace raytruth
