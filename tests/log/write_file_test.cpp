// The one writer: what stands under a name is whole, nothing is left beside it, and what is no file is never replaced.
#include "host_tools/log/log.h"
#include "host_tools/log/write_file.h"

#include <gtest/gtest.h>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>

namespace traction::log {
namespace {

namespace fs = std::filesystem;

class Writer : public testing::Test {
  protected:
    void SetUp() override {
        std::string pattern = (fs::temp_directory_path() / "traction_writer_XXXXXX").string();
        ASSERT_NE(mkdtemp(pattern.data()), nullptr);
        folder = pattern;
    }
    void TearDown() override {
        std::error_code ignored;
        fs::permissions(folder, fs::perms::owner_all, ignored);
        fs::remove_all(folder, ignored);
    }
    std::string at(const std::string &name) const { return (folder / name).string(); }
    long names() const { return std::distance(fs::directory_iterator(folder), fs::directory_iterator()); }
    static std::string text(const std::string &path) {
        std::ifstream file(path, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    }
    static std::string message(const std::string &path) {
        try {
            write_file("x", path);
        } catch (const FileError &error) {
            return error.what();
        }
        return "";
    }
    fs::path folder;
};

TEST_F(Writer, replaces_a_file_whole_keeps_its_mode_and_leaves_nothing_beside_it) {
    write_file("old", at("a"));
    ASSERT_EQ(chmod(at("a").c_str(), 0640), 0);
    write_file("new", at("a"));
    struct stat info {};
    ASSERT_EQ(stat(at("a").c_str(), &info), 0);
    EXPECT_EQ(text(at("a")), "new");
    EXPECT_EQ(info.st_mode & 0777, 0640U);
    EXPECT_EQ(names(), 1);
}

TEST_F(Writer, given_up_leaves_the_old_file_and_nothing_else) {
    write_file("old", at("a"));
    {
        WholeFile file(at("a"));
        file.write(std::string(1 << 20, 'x'));
        EXPECT_EQ(names(), 3); // the file, the temporary, the lock
    }
    EXPECT_EQ(text(at("a")), "old");
    EXPECT_EQ(names(), 1);
}

TEST_F(Writer, replaces_what_a_link_points_at_and_the_link_stays) {
    write_file("old", at("target"));
    fs::create_symlink("target", at("link"));
    write_file("new", at("link"));
    EXPECT_TRUE(fs::is_symlink(at("link")));
    EXPECT_EQ(text(at("target")), "new");
    fs::create_symlink("not yet", at("dangling"));
    write_file("made", at("dangling"));
    EXPECT_TRUE(fs::is_symlink(at("dangling")));
    EXPECT_EQ(text(at("not yet")), "made");
    fs::create_symlink("round", at("round"));
    EXPECT_NE(message(at("round")).find("round: cannot be written: "), std::string::npos);
    EXPECT_EQ(names(), 5);
}

TEST_F(Writer, never_follows_a_link_that_waits_at_the_old_temporarys_name) {
    write_file("precious", at("victim"));
    fs::create_symlink("victim", at("a.part"));
    fs::create_symlink("victim", at(".a.part"));
    write_file("new", at("a"));
    EXPECT_EQ(text(at("victim")), "precious");
    fs::create_symlink("victim", at(".b.lock")); // a link at the lock's name is refused as well
    EXPECT_NE(message(at("b")), "");
    EXPECT_EQ(text(at("victim")), "precious");
}

TEST_F(Writer, writes_to_a_fifo_and_leaves_it_a_fifo) {
    ASSERT_EQ(mkfifo(at("pipe").c_str(), 0600), 0);
    std::string got;
    std::thread reader([&] { got = text(at("pipe")); });
    write_file("through", at("pipe"));
    reader.join();
    EXPECT_EQ(got, "through");
    EXPECT_TRUE(fs::is_fifo(at("pipe")));
    EXPECT_EQ(names(), 1);
}

TEST_F(Writer, writes_to_a_device_and_leaves_it_a_device) {
    if (geteuid() != 0 || mknod(at("null").c_str(), S_IFCHR | 0666, (1 << 8) | 3) != 0) // Linux: 1, 3 is the null device
        GTEST_SKIP() << "only root may make a device to try it on";
    const int fd = open(at("null").c_str(), O_WRONLY);
    if (fd < 0) GTEST_SKIP() << "devices do not work in this folder";
    close(fd);
    write_file("gone", at("null"));
    EXPECT_TRUE(fs::is_character_file(at("null")));
    EXPECT_EQ(names(), 1);
}

TEST_F(Writer, full_device_is_told_with_the_systems_words) {
    if (!fs::is_character_file("/dev/full")) GTEST_SKIP() << "no /dev/full here";
    EXPECT_NE(message("/dev/full").find("/dev/full: cannot be written: No space left on device"), std::string::npos)
        << message("/dev/full");
    EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST_F(Writer, failure_halfway_leaves_the_old_file_and_no_temporary) {
    write_file("old", at("a"));
    const pid_t child = fork(); // a limit on the size of files acts like a full disk: EFBIG
    if (child == 0) {
        signal(SIGXFSZ, SIG_IGN);
        const struct rlimit limit { 4096, 4096 };
        setrlimit(RLIMIT_FSIZE, &limit);
        try {
            write_file(std::string(1 << 20, 'x'), at("a"));
        } catch (const FileError &) {
            _exit(7);
        }
        _exit(1);
    }
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_EQ(WEXITSTATUS(status), 7);
    EXPECT_EQ(text(at("a")), "old");
    EXPECT_EQ(names(), 1);
}

TEST_F(Writer, every_failure_names_the_path_and_the_systems_words) {
    EXPECT_NE(message(at("no/x")).find(at("no/x") + ": cannot be written: No such file or directory"), std::string::npos);
    EXPECT_NE(message(folder.string()).find(": cannot be written: Is a directory"), std::string::npos);
    if (geteuid() == 0) GTEST_SKIP() << "root may write into any folder";
    fs::permissions(folder, fs::perms::owner_read | fs::perms::owner_exec);
    EXPECT_NE(message(at("x")).find(": cannot be written: Permission denied"), std::string::npos);
}

TEST_F(Writer, second_program_is_refused_while_the_first_writes_and_may_write_afterwards) {
    int ready[2];
    ASSERT_EQ(pipe(ready), 0);
    const pid_t child = fork();
    if (child == 0) {
        const Claim claim(at("a"));
        if (write(ready[1], "x", 1) != 1) _exit(1);
        pause();
    }
    char c = 0;
    ASSERT_EQ(read(ready[0], &c, 1), 1);
    EXPECT_NE(message(at("a")).find("is being written by another run"), std::string::npos);
    fs::create_symlink("a", at("other name"));
    EXPECT_NE(message(at("other name")).find("is being written by another run"), std::string::npos);
    kill(child, SIGKILL); // its lock file stays, its lock does not
    waitpid(child, nullptr, 0);
    EXPECT_EQ(message(at("a")), "");
    EXPECT_EQ(text(at("a")), "x");
    EXPECT_FALSE(fs::exists(at(".a.lock")));
    close(ready[0]), close(ready[1]);
}

TEST_F(Writer, claim_of_this_program_does_not_refuse_itself) {
    const Claim claim(at("a"));
    EXPECT_EQ(message(at("a")), "");
    EXPECT_TRUE(fs::exists(at(".a.lock"))); // until the claim ends
}

TEST_F(Writer, name_as_long_as_the_system_allows_is_written) {
    const std::string name(255, 'n');
    write_file("x", at(name));
    EXPECT_EQ(text(at(name)), "x");
    EXPECT_EQ(names(), 1);
}

} // namespace
} // namespace traction::log
