// Functions of place and time: their values, and what is said of those that cannot be read.

#include "protocol/function.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace duet::protocol {
namespace {

Function formula(const std::string& text) {
    v1::Function function;
    function.set_formula(text);
    return Function(function);
}

v1::Function table(std::initializer_list<double> time, std::initializer_list<double> value) {
    v1::Function function;
    function.mutable_table()->mutable_time()->Add(time.begin(), time.end());
    function.mutable_table()->mutable_value()->Add(value.begin(), value.end());
    return function;
}

TEST(Function, NumberIsTheSameEverywhere) {
    v1::Function number;
    number.set_number(3.5);
    const Function f(number);
    EXPECT_EQ(f(1, 2, 3), 3.5);
    EXPECT_FALSE(f.depends_on_place() || f.depends_on_time());
    EXPECT_EQ(number_of(number, "it"), 3.5);
}

TEST(Function, FormulaTakesPlaceAndTime) {
    const Function f = formula("300 + 10*sin(pi*x)*y^2 + (t < 2 ? t/2 : 1)");
    EXPECT_DOUBLE_EQ(f(0.25, 3, 1), 300 + 90 * std::sin(std::acos(-1.0) / 4) + 0.5);
    EXPECT_DOUBLE_EQ(f(0, 3, 5), 301);
    EXPECT_TRUE(f.depends_on_place() && f.depends_on_time());
    EXPECT_FALSE(formula("2*y").depends_on_time());
    EXPECT_FALSE(formula("2*t").depends_on_place());
}

TEST(Function, CopiesGiveTheSameValues) {
    const Function f = formula("x + 10*t");
    const Function g = f;
    EXPECT_EQ(f(1, 0, 2), 21);
    EXPECT_EQ(g(3, 0, 4), 43);
}

TEST(Function, TableIsLinearBetweenItsTimesAndConstantBeyond) {
    const Function f(table({1, 2, 4}, {10, 20, 0}));
    EXPECT_EQ(f(0, 0, 0), 10);
    EXPECT_EQ(f(0, 0, 1), 10);
    EXPECT_EQ(f(0, 0, 1.25), 12.5);
    EXPECT_EQ(f(0, 0, 2), 20);
    EXPECT_EQ(f(0, 0, 3), 10);
    EXPECT_EQ(f(0, 0, 9), 0);
    EXPECT_TRUE(f.depends_on_time());
}

TEST(Function, WhatCannotBeReadIsRefused) {
    EXPECT_THROW(formula("x +"), std::invalid_argument);
    EXPECT_THROW(formula("z"), std::invalid_argument);
    EXPECT_THROW(formula(""), std::invalid_argument);
    EXPECT_THROW(formula("x = 3"), std::invalid_argument);
    EXPECT_THROW(formula("300, 400"), std::invalid_argument);
    EXPECT_EQ(formula("(x <= 1) + (x >= 1) + (x == 1) + (x != 1)")(1, 0, 0), 3);
    EXPECT_THROW(Function(table({}, {})), std::invalid_argument);
    EXPECT_THROW(Function(table({0, 1}, {1})), std::invalid_argument);
    EXPECT_THROW(Function(table({1, 1}, {1, 2})), std::invalid_argument);
    EXPECT_THROW(number_of(table({0}, {1}), "it"), std::invalid_argument);
    EXPECT_THROW(formula("1/x")(0, 0, 0), std::runtime_error);
    EXPECT_EQ(formula("1/x")(2, 0, 0), 0.5);
}

} // namespace
} // namespace duet::protocol
