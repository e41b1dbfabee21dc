// The audit finds what does not balance, and knows what is under way.

#include "orchestrator/audit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace duet::orchestrator {
namespace {

/// Books of a side that has received `heat` through the interface and keeps it.
v1::Ledger books(double heat, double exchanged) {
    v1::Ledger ledger;
    ledger.set_heat(heat);
    ledger.set_heat_from_interface(heat);
    ledger.set_exchanged_heat(exchanged);
    return ledger;
}

TEST(Audit, BalancedBooksPass) {
    Audit audit(v1::Coupling::FLUID_FIRST, 1e-12);
    const v1::Ledger start;
    audit.start(&start, &start);
    for (int k = 1; k < 5; ++k) {
        const v1::Ledger solid = books(-3.0 * k, 3.0 * k);
        const v1::Ledger fluid = books(3.0 * k, 3.0 * k);
        EXPECT_EQ(audit.window(&solid, &fluid), std::nullopt);
    }
    EXPECT_EQ(audit.balances().heat, 0);
    EXPECT_EQ(audit.balances().total_heat_drift, 0);
}

TEST(Audit, LostHeatEndsTheRun) {
    Audit audit(v1::Coupling::FLUID_FIRST, 1e-12);
    const v1::Ledger start;
    audit.start(&start, &start);
    const v1::Ledger solid = books(-100, 100);
    const v1::Ledger fluid = books(100 * (1 + 1e-9), 100);
    const auto sentence = audit.window(&solid, &fluid);
    ASSERT_TRUE(sentence);
    EXPECT_NE(sentence->find("heat through the interface does not balance"), std::string::npos);
    EXPECT_NEAR(audit.balances().heat, 1e-9, 1e-12);
}

TEST(Audit, LostImpulseEndsTheRun) {
    Audit audit(v1::Coupling::FLUID_FIRST, 1e-12);
    const v1::Ledger start;
    audit.start(&start, &start);
    v1::Ledger solid;
    solid.set_impulse_y(5);
    solid.set_exchanged_impulse(10);
    v1::Ledger fluid = solid; // the same sign: it was not handed over
    const auto sentence = audit.window(&solid, &fluid);
    ASSERT_TRUE(sentence);
    EXPECT_NE(sentence->find("impulse"), std::string::npos);
}

TEST(Audit, WithTheSolidFirstTheLastLoadIsUnderWay) {
    for (const auto schedule : {v1::Coupling::SOLID_FIRST, v1::Coupling::PARALLEL}) {
        Audit audit(schedule, 1e-12);
        const v1::Ledger start;
        audit.start(&start, &start);
        for (int k = 1; k < 5; ++k) {
            const v1::Ledger solid = books(-2.0 * (k - 1), 2.0 * (k - 1));
            const v1::Ledger fluid = books(2.0 * k, 2.0 * k);
            EXPECT_EQ(audit.window(&solid, &fluid), std::nullopt) << k;
        }
        EXPECT_EQ(audit.balances().heat, 0);
        EXPECT_EQ(audit.balances().total_heat_drift, 0) << "what is under way is not lost";
    }
}

/// Books that say nothing but work: the solid's own, and on the fluid's side what its loads did.
v1::Ledger work_of_solid(double work) {
    v1::Ledger ledger;
    ledger.set_work(work);
    return ledger;
}
v1::Ledger work_of_loads(double work) {
    v1::Ledger ledger;
    ledger.set_work(-1.1 * work); // in the motion that it predicted
    ledger.set_work_of_loads(work);
    ledger.set_exchanged_work(std::abs(work));
    return ledger;
}

TEST(Audit, TheFluidLearnsTheWorkOfItsLoadsFromTheMotion) {
    for (const auto schedule :
         {v1::Coupling::FLUID_FIRST, v1::Coupling::SOLID_FIRST, v1::Coupling::PARALLEL}) {
        Audit audit(schedule, 1e-12);
        const v1::Ledger start;
        audit.start(&start, &start);
        const int behind = schedule == v1::Coupling::SOLID_FIRST ? 0 : 1;
        for (int k = 1; k < 5; ++k) {
            const v1::Ledger solid = work_of_solid(2.0 * k),
                             fluid = work_of_loads(2.0 * (k - behind));
            EXPECT_EQ(audit.window(&solid, &fluid), std::nullopt) << k;
        }
        EXPECT_EQ(audit.balances().work, 0);
        EXPECT_GT(audit.balances().work_difference, 0.05);
        const v1::Ledger solid = work_of_solid(10), fluid = work_of_loads(10 * (1 + 1e-6));
        audit.window(&solid, &fluid);
        const auto sentence = audit.window(&solid, &fluid);
        ASSERT_TRUE(sentence);
        EXPECT_NE(sentence->find("work"), std::string::npos);
    }
}

TEST(Audit, HeatThatCameFromNowhereIsDrift) {
    Audit audit(v1::Coupling::FLUID_FIRST, 1e-12);
    const v1::Ledger start;
    audit.start(&start, &start);
    v1::Ledger solid = books(-10, 10);
    v1::Ledger fluid = books(10, 10);
    fluid.set_heat(11);
    EXPECT_EQ(audit.window(&solid, &fluid), std::nullopt);
    EXPECT_DOUBLE_EQ(audit.balances().total_heat_drift, 0.1);
}

TEST(Audit, HeatDriftIsMeasuredByWhatPassesTheWalls) {
    Audit audit(v1::Coupling::FLUID_FIRST, 1e-12);
    const v1::Ledger start;
    audit.start(nullptr, &start);
    v1::Ledger fluid; // one wall gave 500, the other took 498, and the fluid holds 1
    fluid.set_heat(1);
    fluid.set_heat_from_walls(2);
    (*fluid.mutable_figure())["heat_through_walls"] = 998;
    EXPECT_EQ(audit.window(nullptr, &fluid), std::nullopt);
    EXPECT_DOUBLE_EQ(audit.balances().total_heat_drift, 1.0 / 998);
}

TEST(Audit, WallsAndSourcesExplainHeat) {
    Audit audit(v1::Coupling::FLUID_FIRST, 1e-12);
    const v1::Ledger start;
    audit.start(nullptr, &start);
    v1::Ledger fluid;
    fluid.set_heat(7);
    fluid.set_heat_from_walls(4);
    fluid.set_heat_from_sources(3);
    EXPECT_EQ(audit.window(nullptr, &fluid), std::nullopt);
    EXPECT_EQ(audit.balances().total_heat_drift, 0);
}

TEST(Audit, NumbersThatAreNotFiniteEndTheRun) {
    Audit audit(v1::Coupling::FLUID_FIRST, 1e-12);
    const v1::Ledger start;
    audit.start(&start, &start);
    v1::Ledger solid;
    solid.set_heat(std::numeric_limits<double>::quiet_NaN());
    const auto sentence = audit.window(&solid, &start);
    ASSERT_TRUE(sentence);
    EXPECT_NE(sentence->find("ledger of the solid"), std::string::npos);
}

TEST(Audit, MassIsFollowed) {
    Audit audit(v1::Coupling::FLUID_FIRST, 1e-12);
    v1::Ledger start;
    start.set_mass(4);
    audit.start(nullptr, &start);
    v1::Ledger later = start;
    later.set_mass(4.04);
    EXPECT_EQ(audit.window(nullptr, &later), std::nullopt);
    EXPECT_NEAR(audit.balances().mass_drift, 0.01, 1e-12);
}

} // namespace
} // namespace duet::orchestrator
