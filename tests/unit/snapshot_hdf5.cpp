#include "snapshot/hdf5.hpp"
#include "tests/unit/snapshot_support.hpp"

namespace duet::snapshot {
namespace {

using Hdf5 = test::Folder;

TEST_F(Hdf5, ReadsBackWhatWasWritten) {
    const std::vector<double> values{1.5, -2, 3, 0.1, 1e300, -0.0};
    const std::vector<std::uint64_t> counts{0, 1ULL << 40};
    {
        hdf5::File file(folder / "a.h5");
        hdf5::Group group = file.create("one");
        group.write<double>("values", values, {2, 3});
        group.write<std::uint64_t>("counts", counts, {2});
    }
    {
        hdf5::File file(folder / "b.h5");
        file.refer("two", "a.h5", "/one");
    }
    EXPECT_EQ(test::read(folder / "a.h5", "/one/values").shape, (std::vector<hsize_t>{2, 3}));
    EXPECT_EQ(test::read(folder / "a.h5", "/one/values").values, values);
    EXPECT_EQ(test::read(folder / "b.h5", "/two/values").values, values);
    EXPECT_EQ(test::read(folder / "a.h5", "/one/counts").values,
              (std::vector<double>{0, 1099511627776.0}));
}

TEST_F(Hdf5, AttributesAreReadByPython) {
    {
        hdf5::File file(folder / "a.h5");
        file.attribute("title", std::string("Wärme & Fluss"));
        file.attribute("empty", std::string());
        file.attribute("time", 0.1);
    }
    const auto printed =
        test::run("/usr/bin/python3 -c \"import h5py; a = h5py.File('" + (folder / "a.h5").string()
                  + "').attrs; print(a['title'].decode(), [a['empty'].decode()], a['time'])\"");
    EXPECT_EQ(printed.text, "Wärme & Fluss [''] 0.1\n");
}

TEST_F(Hdf5, ASecondDataSetOfOneNameIsASentence) {
    hdf5::File file(folder / "a.h5");
    const std::vector<double> one{1};
    file.write<double>("x", one, {1});
    try {
        file.write<double>("x", one, {1});
        FAIL() << "the name was taken";
    } catch (const std::runtime_error& error) {
        const std::string sentence = error.what();
        EXPECT_NE(sentence.find("cannot create data set x in " + (folder / "a.h5").string()),
                  std::string::npos)
            << sentence;
        EXPECT_NE(sentence.find("already exists"), std::string::npos) << sentence;
    }
}

TEST_F(Hdf5, AShapeThatDoesNotFitIsRefused) {
    hdf5::File file(folder / "a.h5");
    const std::vector<double> five(5);
    EXPECT_THROW(file.write<double>("x", five, {2, 3}), std::invalid_argument);
}

} // namespace
} // namespace duet::snapshot
