#include "protocol/function.hpp"

#include <muParser.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>

namespace duet::protocol {

namespace {

/// A '=' that is no part of <=, >=, == or !=.
bool assigns(const std::string& text) {
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '=') {
            continue;
        }
        const bool doubled = i + 1 < text.size() && text[i + 1] == '=';
        if (!doubled && (i == 0 || std::string("<>!=").find(text[i - 1]) == std::string::npos)) {
            return true;
        }
        i += doubled ? 1 : 0;
    }
    return false;
}

} // namespace

/// The parser reads its variables from where they were bound.
struct Function::Formula {
    double x = 0, y = 0, t = 0;
    bool of_place = false, of_time = false;
    mu::Parser parser;

    explicit Formula(const std::string& text) {
        parser.DefineConst("pi", std::acos(-1.0));
        parser.DefineVar("x", &x);
        parser.DefineVar("y", &y);
        parser.DefineVar("t", &t);
        if (assigns(text)) {
            throw std::invalid_argument("the formula '" + text
                                        + "' holds a single '=', which would change its "
                                          "variables; write == to compare.");
        }
        try {
            parser.SetExpr(text);
            int results = 0;
            parser.Eval(results); // before GetUsedVar, which forgives unknown names
            const auto& used = parser.GetUsedVar();
            of_place = used.count("x") > 0 || used.count("y") > 0;
            of_time = used.count("t") > 0;
            if (results != 1) {
                throw std::invalid_argument("the formula '" + text + "' holds "
                                            + std::to_string(results)
                                            + " values where one is due; write 0.5, not 0,5.");
            }
        } catch (const mu::Parser::exception_type& fault) {
            throw std::invalid_argument("the formula '" + text
                                        + "' cannot be read: " + fault.GetMsg()
                                        + " It may use x, y, t, pi, and the operators and "
                                          "functions of docs/case-file.md.");
        }
    }
};

namespace {

void check_table(const v1::TimeTable& table) {
    if (table.time_size() == 0 || table.time_size() != table.value_size()) {
        throw std::invalid_argument("a table in time needs as many values as times, and one at "
                                    "least; it has "
                                    + std::to_string(table.time_size()) + " times and "
                                    + std::to_string(table.value_size()) + " values.");
    }
    for (int i = 0; i < table.time_size(); ++i) {
        if (!std::isfinite(table.time(i)) || (i > 0 && !(table.time(i) > table.time(i - 1)))) {
            throw std::invalid_argument("the times of a table must rise; entry " + std::to_string(i)
                                        + " does not.");
        }
    }
}

/// Linear between the times, constant beyond them.
double interpolate(const v1::TimeTable& table, double t) {
    const auto& time = table.time();
    const auto after =
        static_cast<int>(std::upper_bound(time.begin(), time.end(), t) - time.begin());
    if (after == 0) {
        return table.value(0);
    }
    if (after == time.size()) {
        return table.value(after - 1);
    }
    const double share = (t - time[after - 1]) / (time[after] - time[after - 1]);
    return table.value(after - 1) + share * (table.value(after) - table.value(after - 1));
}

} // namespace

Function::Function(const v1::Function& function) : function_(function) {
    if (function.has_formula()) {
        formula_ = std::make_shared<Formula>(function.formula());
    } else if (function.has_table()) {
        check_table(function.table());
    }
}

double Function::operator()(double x, double y, double t) const {
    if (formula_) {
        formula_->x = x;
        formula_->y = y;
        formula_->t = t;
        const double value = formula_->parser.Eval();
        if (!std::isfinite(value)) {
            std::ostringstream sentence;
            sentence << "the formula '" << function_.formula()
                     << "' has no finite value at x = " << x << ", y = " << y << ", t = " << t
                     << ".";
            throw std::runtime_error(sentence.str());
        }
        return value;
    }
    return function_.has_table() ? interpolate(function_.table(), t) : function_.number();
}

bool Function::depends_on_time() const {
    return formula_ ? formula_->of_time : function_.has_table();
}

bool Function::depends_on_place() const {
    return formula_ && formula_->of_place;
}

bool is_zero(const v1::Function& function) {
    return !function.has_formula() && !function.has_table() && function.number() == 0;
}

bool is_zero(const v1::VectorFunction& function) {
    return is_zero(function.x()) && is_zero(function.y());
}

double number_of(const v1::Function& function, const char* what) {
    if (function.has_formula() || function.has_table()) {
        throw std::invalid_argument(std::string(what) + " must be a number here.");
    }
    return function.number();
}

} // namespace duet::protocol
