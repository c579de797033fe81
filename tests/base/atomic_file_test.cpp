#include "base/atomic_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace keyhole {
namespace {

namespace fs = std::filesystem;

class AtomicFileTest : public testing::Test {
  protected:
    AtomicFileTest() {
        std::string pattern = (fs::temp_directory_path() / "keyhole-XXXXXX").string();
        folder_ = mkdtemp(pattern.data());
    }
    ~AtomicFileTest() override { fs::remove_all(folder_); }

    std::string file(const std::string& name) const { return (folder_ / name).string(); }
    std::size_t files() const {
        return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
    }
    static std::string contents(const std::string& filename) {
        std::ostringstream text;
        text << std::ifstream(filename, std::ios::binary).rdbuf();
        return text.str();
    }
    static std::string refusal(const std::string& filename) {
        try {
            check_writable(filename);
        } catch (const std::runtime_error& e) {
            return e.what();
        }
        return "";
    }

    fs::path folder_;
};

TEST_F(AtomicFileTest, AppearsOnlyWhenCommitted) {
    AtomicFile unfinished(file("a b.txt"));
    std::ofstream(unfinished.path()) << "new";
    EXPECT_FALSE(fs::exists(file("a b.txt")));
    EXPECT_EQ(fs::path(unfinished.path()).parent_path(), folder_);
    unfinished.commit();
    EXPECT_EQ(contents(file("a b.txt")), "new");
    EXPECT_EQ(files(), 1u);
}

TEST_F(AtomicFileTest, AbandonedFileLeavesTheEarlierOne) {
    write_file(file("a.txt"), "old");
    {
        const AtomicFile unfinished(file("a.txt"));
        std::ofstream(unfinished.path()) << "half";
        EXPECT_EQ(files(), 2u);
    }
    EXPECT_EQ(contents(file("a.txt")), "old");
    EXPECT_EQ(files(), 1u);
}

TEST_F(AtomicFileTest, TwoFilesOfOneNameDoNotShareATemporary) {
    const AtomicFile a(file("a.txt")), b(file("a.txt"));
    EXPECT_NE(a.path(), b.path());
}

TEST_F(AtomicFileTest, SignalHandlersCanRemoveUnfinishedFiles) {
    AtomicFile unfinished(file("a.txt")), done(file("b.txt"));
    std::ofstream(unfinished.path()) << "half";
    std::ofstream(done.path()) << "whole";
    done.commit();
    remove_unfinished_files();
    EXPECT_FALSE(fs::exists(unfinished.path()));
    EXPECT_TRUE(fs::exists(file("b.txt")));
    EXPECT_THROW(unfinished.commit(), std::runtime_error);
}

TEST_F(AtomicFileTest, CheckWritableNamesTheReasonAndLeavesNothing) {
    EXPECT_EQ(refusal(file("a.exr")), "");
    EXPECT_EQ(files(), 0u);
    EXPECT_EQ(refusal(file("none/a.exr")),
              "cannot write '" + file("none/a.exr") + "': the folder '" + file("none") + "' does not exist");
    EXPECT_EQ(refusal(folder_.string()), "cannot write '" + folder_.string() + "': it is a folder");
    write_file(file("plain"), "x");
    EXPECT_NE(refusal(file("plain/a.exr")).find("plain/a.exr"), std::string::npos);
    EXPECT_EQ(files(), 1u);
}

TEST_F(AtomicFileTest, WriteFileReportsAMissingFolder) {
    EXPECT_THROW(write_file(file("none/a.txt"), "x"), std::runtime_error);
}

}  // namespace
}  // namespace keyhole
