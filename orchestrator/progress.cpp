#include "orchestrator/progress.hpp"

#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <iostream>

namespace duet::orchestrator {

namespace {

constexpr int bar_width = 30;
constexpr auto bar_pause = std::chrono::milliseconds(200);
constexpr auto line_pause = std::chrono::seconds(10);

template <class... Values>
std::string format(const char* pattern, Values... values) {
    char text[160];
    std::snprintf(text, sizeof text, pattern, values...);
    return text;
}

} // namespace

std::string duration_text(double seconds) {
    if (!(seconds < 3.6e9))
        return format("%.1e h", seconds / 3600);
    const long whole = std::lround(std::max(0.0, seconds));
    if (seconds < 9.95)
        return format("%.1f s", seconds);
    if (whole < 120)
        return format("%ld s", whole);
    if (whole < 2 * 3600)
        return format("%ld min %ld s", whole / 60, whole % 60);
    return format("%ld h %ld min", whole / 3600, whole / 60 % 60);
}

Progress::Progress(double end) : end_(end), terminal_(::isatty(STDOUT_FILENO) == 1) {}

Progress::~Progress() {
    clear();
}

void Progress::reached(double time) {
    const Clock::time_point now = Clock::now();
    if (now - shown_ < (terminal_ ? Clock::duration(bar_pause) : Clock::duration(line_pause)))
        return;
    shown_ = now;
    draw(time, now);
}

void Progress::draw(double time, Clock::time_point now) {
    const double wall = std::chrono::duration<double>(now - begun_).count();
    const double share = time / end_;
    const std::string left =
        share > 0 ? duration_text(wall * (1 - share) / share) : std::string("some time");
    const std::string numbers =
        format("t = %.4g of %.4g s  %3.0f %%  %.3g s/s, ", time, end_, 100 * share, time / wall)
        + left + " left";
    if (!terminal_) {
        std::cout << numbers << std::endl;
        return;
    }
    std::string bar(bar_width, '.');
    bar.replace(0,
                static_cast<std::size_t>(share * bar_width),
                static_cast<std::size_t>(share * bar_width),
                '#');
    std::cout << "\r\033[K[" << bar << "] " << numbers << std::flush;
    drawn_ = true;
}

void Progress::clear() {
    if (drawn_)
        std::cout << "\r\033[K" << std::flush;
    drawn_ = false;
}

void Progress::say(const std::string& line) {
    clear();
    std::cout << line << std::endl;
}

} // namespace duet::orchestrator
