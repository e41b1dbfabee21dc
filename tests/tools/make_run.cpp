// Writes a small run's folder for the tests of tools/: a square plate in a square cavity, its
// fields by formulas, with the library that the solvers write theirs with.

#include "snapshot/series.hpp"

#include <cmath>
#include <cstdio>
#include <fstream>
#include <vector>

namespace {

using duet::snapshot::Cell;
using duet::snapshot::Series;

constexpr double start = 3, end = 7, width = 10;

void write_fluid(Series& series, double time, double spacing) {
    std::vector<double> position, temperature, velocity, pressure;
    const int cells = static_cast<int>(std::lround(width / spacing));
    for (int i = 0; i < cells; ++i) {
        for (int j = 0; j < cells; ++j) {
            const double x = (i + 0.5) * spacing, y = (j + 0.5) * spacing;
            if (x > start && x < end && y > start && y < end)
                continue;
            const double rise = time * std::exp(-std::pow(x - 5, 2)) * std::sin(M_PI * y / width);
            position.insert(position.end(), {x, y});
            temperature.push_back(1000 + 60 * rise);
            velocity.insert(velocity.end(), {0.3 * (5 - x) * rise, rise});
            pressure.push_back(std::cos(M_PI * x / width) * time);
        }
    }
    series.append(
        {time,
         position,
         {},
         {{"temperature", 1, temperature}, {"velocity", 2, velocity}, {"pressure", 1, pressure}}});
}

void write_solid(Series& series, double time, unsigned cells) {
    std::vector<double> position, temperature;
    std::vector<std::uint32_t> triangles;
    for (unsigned j = 0; j <= cells; ++j)
        for (unsigned i = 0; i <= cells; ++i) {
            const double x = start + (end - start) * i / cells;
            const double y = start + (end - start) * j / cells;
            position.insert(position.end(), {x, y});
            temperature.push_back(2000 - 30 * time * std::hypot(x - 5, y - 5));
        }
    for (unsigned j = 0; j < cells; ++j)
        for (unsigned i = 0; i < cells; ++i) {
            const unsigned a = j * (cells + 1) + i, b = a + cells + 1;
            triangles.insert(triangles.end(), {a, a + 1, b + 1, a, b + 1, b});
        }
    series.append({time, position, triangles, {{"temperature", 1, temperature}}});
}

} // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fputs("usage: make_run FOLDER\n", stderr);
        return 2;
    }
    const std::filesystem::path folder = argv[1];
    Series fluid(folder / "fluid", Cell::vertex);
    Series solid(folder / "solid", Cell::triangle);
    std::ofstream probes(folder / "probes.csv");
    probes << "time,plate_centre,fluid_mean,kinetic_energy\n";
    for (int frame = 0; frame <= 4; ++frame) {
        const double time = 0.5 * frame;
        write_fluid(fluid, time, 0.2);
        write_solid(solid, time, 16);
        probes << time << ',' << 2000 - 10 * time << ',' << 1000 + 20 * time << ',' << time * time
               << '\n';
    }
    std::ofstream(folder / "case.toml") << R"(title = "A plate, by formulas"
[fluid]
spacing = 0.2
[[probe]]
name = "plate_centre"
quantity = "temperature"
[[probe]]
name = "fluid_mean"
quantity = "mean_temperature"
[[probe]]
name = "kinetic_energy"
quantity = "kinetic_energy"
[[check]]
quantity = "plate_centre"
reference = "reference/history.csv"
column = "T_K"
)";
    std::ofstream(folder / "history.csv")
        << "# by formula\nt,T_K\n0,2000\n1,1991\n2,1979\n9,1900\n";
}
