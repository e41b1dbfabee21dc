#include "snapshot/series.hpp"
#include "tests/unit/snapshot_support.hpp"

#include <algorithm>
#include <csignal>
#include <iterator>
#include <sstream>
#include <sys/wait.h>
#include <unistd.h>

namespace duet::snapshot {
namespace {

using Shape = std::vector<hsize_t>;
using Numbers = std::vector<double>;

class Snapshots : public test::Folder {
  protected:
    /// The number of frames a reader of each XDMF finds, or what is wrong with them.
    static std::string checked(const std::string& arguments) {
        return test::run("/usr/bin/python3 " DUET_SOURCE_DIR "/tests/unit/snapshot_check.py "
                         + arguments)
            .text;
    }
    std::string readable() const { return checked((folder / "s").string()); }
    test::Array at(const std::string& place) const { return test::read(folder / "s.h5", place); }
};

TEST_F(Snapshots, TrianglesMoveAndKeepTheirFields) {
    const Numbers start{0, 0, 1, 0, 1, 1, 0, 1};
    const Numbers moved{0, 0, 1, 0.5, 1, 1.5, 0, 1};
    const std::vector<std::uint32_t> triangles{0, 1, 2, 0, 2, 3};
    const Numbers temperature{300, 301, 302, 303};
    const Numbers displacement{0, 0, 0, 0.5, 0, 0.5, 0, 0};
    const Numbers stress{1, 0, 0, 2, 0, 3, 4, 0, 0, 5, 0, 6};
    {
        Series series(folder / "s", Cell::triangle, {{"title", "a square"}});
        series.append({0, start, triangles, {{"temperature", 1, temperature}}});
        series.append({0.1,
                       moved,
                       triangles,
                       {{"temperature", 1, temperature},
                        {"displacement", 2, displacement},
                        {"stress", 6, stress, true}}});
    }
    EXPECT_EQ(readable(), "2\n");
    EXPECT_EQ(at("/frame_000001/position").shape, (Shape{4, 3}));
    EXPECT_EQ(at("/frame_000001/position").values,
              (Numbers{0, 0, 0, 1, 0.5, 0, 1, 1.5, 0, 0, 1, 0}));
    EXPECT_EQ(at("/frame_000001/connectivity").values, (Numbers{0, 1, 2, 0, 2, 3}));
    EXPECT_EQ(at("/frame_000001/displacement").values,
              (Numbers{0, 0, 0, 0, 0.5, 0, 0, 0.5, 0, 0, 0, 0}));
    EXPECT_EQ(at("/frame_000001/stress").shape, (Shape{2, 6}));
    EXPECT_EQ(at("/frame_000001/stress").values, stress);
    const std::string xdmf = test::text(folder / "s.xdmf");
    EXPECT_NE(xdmf.find("Time Value=\"0.1\""), std::string::npos) << xdmf;
    EXPECT_NE(xdmf.find("AttributeType=\"Tensor6\" Center=\"Cell\""), std::string::npos) << xdmf;
}

TEST_F(Snapshots, ParticlesMayChangeInNumber) {
    {
        Series series(folder / "s", Cell::vertex);
        for (const std::size_t count : {3U, 5U, 1U}) {
            const Numbers position(2 * count, 1.0);
            const Numbers pressure(count, 7.0);
            series.append({static_cast<double>(count), position, {}, {{"pressure", 1, pressure}}});
        }
        EXPECT_EQ(readable(), "3\n") << "readers need not wait for the end of a run";
    }
    EXPECT_EQ(at("/frame_000001/connectivity").values, (Numbers{0, 1, 2, 3, 4}));
    EXPECT_EQ(at("/frame_000002/pressure").shape, (Shape{1}));
}

TEST_F(Snapshots, AnUnchangedMeshIsStoredOnce) {
    const Numbers position(20000, 0.5);
    Series series(folder / "s", Cell::vertex);
    series.append({0, position, {}, {}});
    for (int frame = 1; frame < 10; ++frame)
        series.append({1.0 * frame, position, {}, {}});
    EXPECT_EQ(readable(), "10\n");
    // One frame's positions are 480 kB; files with two links are a few kB each.
    std::uintmax_t others = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder / "s_frames"))
        if (entry.path().filename() != "frame_000000.h5")
            others += entry.file_size();
    EXPECT_LT(others, 40000U);
}

/// Frame n has 50 + n particles of temperature n. Ends by a signal, or with status 1 on an error.
[[noreturn]] void append_for_ever(const std::filesystem::path& stem) try {
    Series series(stem, Cell::vertex);
    for (std::size_t frame = 0;; ++frame) {
        const Numbers position(2 * (50 + frame), 0.0);
        const Numbers temperature(50 + frame, static_cast<double>(frame));
        series.append(
            {static_cast<double>(frame), position, {}, {{"temperature", 1, temperature}}});
    }
} catch (const std::exception& error) {
    std::fputs(error.what(), stderr);
    _exit(1);
}

TEST_F(Snapshots, AKilledWriterLeavesAReadableSeries) {
    constexpr int trials = 20;
    std::string stems;
    for (int trial = 0; trial < trials; ++trial) {
        const std::filesystem::path stem = folder / ("s" + std::to_string(trial));
        stems += " " + stem.string();
        const pid_t writer = fork();
        if (writer == 0)
            append_for_ever(stem);
        // Odd times, so that the kill falls on every part of an append.
        usleep(static_cast<useconds_t>(20011 + 2917 * trial));
        kill(writer, SIGKILL);
        int status = 0;
        waitpid(writer, &status, 0);
        ASSERT_TRUE(WIFSIGNALED(status)) << "the writer ended by itself";
    }
    const std::string counts = checked(stems + " --sealed");
    std::istringstream list(counts);
    const Numbers frames{std::istream_iterator<double>(list), {}};
    ASSERT_EQ(frames.size(), std::size_t{trials}) << counts;
    EXPECT_GT(*std::ranges::max_element(frames), 2)
        << "no writer got far enough for the test to mean anything";
}

TEST_F(Snapshots, ReplacesAnEarlierSeries) {
    const Numbers position{0, 0};
    for (int frames : {3, 1}) {
        Series series(folder / "s", Cell::vertex);
        EXPECT_EQ(readable(), "0\n") << "no XDMF is left that points into the old data";
        for (int frame = 0; frame < frames; ++frame)
            series.append({1.0 * frame, position, {}, {}});
    }
    EXPECT_EQ(readable(), "1\n");
    EXPECT_FALSE(std::filesystem::exists(folder / "s_frames" / "frame_000001.h5"))
        << "a frame of the earlier series is left";
}

/// What `action` throws.
template <class Action>
std::string sentence_of(Action action) {
    try {
        action();
    } catch (const std::exception& error) {
        return error.what();
    }
    return "nothing was thrown";
}

TEST_F(Snapshots, AnUnwritablePathIsASentence) {
    const std::filesystem::path stem = folder / "missing" / "s";
    testing::internal::CaptureStderr();
    const std::string sentence = sentence_of([&] { Series series(stem, Cell::vertex); });
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << "HDF5 printed its error stack";
    EXPECT_NE(sentence.find("cannot create the file " + stem.string() + ".h5"), std::string::npos)
        << sentence;
    EXPECT_NE(sentence.find("No such file or directory"), std::string::npos) << sentence;
}

TEST_F(Snapshots, RefusesWhatDoesNotFit) {
    const Numbers position{0, 0, 1, 0, 0, 1};
    const Numbers three{1, 2, 3};
    const std::vector<std::uint32_t> triangle{0, 1, 2};
    const std::vector<std::uint32_t> beyond{0, 1, 3};
    Series series(folder / "s", Cell::triangle);
    auto refusal = [&](const Frame& frame) { return sentence_of([&] { series.append(frame); }); };
    EXPECT_EQ(refusal({0.5, position, triangle, {{"velocity", 2, three}}}),
              "snapshot at t = 0.5 s: field velocity has 3 values, expected 3 times 2");
    EXPECT_EQ(refusal({0, position, beyond, {}}),
              "snapshot at t = 0 s: connectivity names a node beyond the last point");
    EXPECT_NE(refusal({0, position, triangle, {{"position", 1, three}}}).find("'position'"),
              std::string::npos);
    EXPECT_NE(refusal({0, position, triangle, {{"a", 1, three}, {"a", 1, three}}}).find("'a'"),
              std::string::npos);
    EXPECT_NE(refusal({0, {}, triangle, {}}).find("at least one point"), std::string::npos);
    series.append({0, position, triangle, {{"temperature", 1, three}}});
    EXPECT_EQ(readable(), "1\n") << "a refused frame must leave nothing behind";
}

} // namespace
} // namespace duet::snapshot
