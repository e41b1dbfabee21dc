// The variants of a sweep, and its table.

#include "orchestrator/sweep.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace duet::orchestrator {
namespace {

std::string all(const std::vector<std::string>& overrides) {
    std::string text;
    for (const Variant& variant : variants_of(overrides)) {
        for (const std::string& one : variant.overrides)
            text += one + " ";
        text += "| ";
    }
    return text;
}

TEST(Sweep, ListsMultiplyAndSingleValuesStay) {
    EXPECT_EQ(all({"fluid.spacing=[0.2, 0.1]",
                   "time.end=3",
                   "fluid.formulation=[\"paper\", \"consistent\"]"}),
              "fluid.spacing=0.2 time.end=3 fluid.formulation='paper' | "
              "fluid.spacing=0.2 time.end=3 fluid.formulation='consistent' | "
              "fluid.spacing=0.1 time.end=3 fluid.formulation='paper' | "
              "fluid.spacing=0.1 time.end=3 fluid.formulation='consistent' | ");
    const std::vector<Variant> variants = variants_of({"fluid.spacing=[0.2, 0.1]", "time.end=3"});
    ASSERT_EQ(variants.size(), 2u);
    ASSERT_EQ(variants[1].varied.size(), 1u);
    EXPECT_EQ(variants[1].varied[0].first, "fluid.spacing");
    EXPECT_EQ(variants[1].varied[0].second, "0.1");
}

TEST(Sweep, WhatIsAListByItselfIsOneValue) {
    EXPECT_EQ(variants_of({"gravity=[0, -10]"}).size(), 1u);
    EXPECT_EQ(variants_of({"gravity=[[0, -10], [0, -5]]"}).size(), 2u);
    EXPECT_EQ(variants_of({"fluid.region=[[0, 0], [1, 0], [0, 1]]"}).size(), 1u);
    EXPECT_EQ(variants_of({"check[0].at=[1, 2]"}).size(), 1u);
    EXPECT_EQ(variants_of({"solid.body[0].density=[1, 2]"}).size(), 2u);
    EXPECT_EQ(variants_of({}).size(), 1u);
    EXPECT_EQ(variants_of({"fluid.spacing=[0.2]"}).front().varied.size(), 1u) << "a list of one";
    EXPECT_TRUE(variants_of({"fluid.spacing=0.2"}).front().varied.empty());
    EXPECT_THROW(variants_of({"fluid.spacing"}), std::invalid_argument);
}

TEST(Sweep, TableHoldsErrorsAndCost) {
    std::vector<Trial> trials(2); // of which the second fails
    for (std::size_t i = 0; i < 2; ++i) {
        trials[i].variant = variants_of({"fluid.spacing=[0.2, 0.1]"})[i];
        trials[i].result.players.resize(1);
        trials[i].result.players[0].role = v1::ROLE_FLUID;
        trials[i].result.players[0].steps = 7;
    }
    trials[0].result.ended = Ended::finished;
    trials[0].result.wall_seconds = 2.5;
    trials[0].verdicts.resize(1);
    trials[0].verdicts[0].quantity = "nu, mean of 1 to 2 s";
    trials[0].verdicts[0].error = 0.125;
    const std::string csv = sweep_csv(trials);
    const std::string head = csv.substr(0, csv.find('\n'));
    EXPECT_EQ(head,
              "fluid.spacing,error of nu; mean of 1 to 2 s,cpu_seconds_fluid,steps_fluid,"
              "wall_seconds,ended,revision");
    EXPECT_NE(csv.find("\n0.2,0.125,0,7,2.5,finished,"), std::string::npos) << csv;
    EXPECT_NE(csv.find("\n0.1,,0,7,0,failed,"), std::string::npos) << csv;
}

} // namespace
} // namespace duet::orchestrator
