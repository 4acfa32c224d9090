// Whole files: mapped or read in, and put in place at once or not at all.
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <thread>

#include "io_support.h"

namespace fs = std::filesystem;
using gaussmap::Format;

namespace {

/// A folder of its own for each test, gone afterwards.
struct Folder {
    fs::path path;
    Folder() {
        std::string name = (fs::temp_directory_path() / "gaussmap-test-XXXXXX").string();
        path = ::mkdtemp(name.data());
    }
    ~Folder() { fs::remove_all(path); }
    std::string file(const std::string& name) const { return (path / name).string(); }
    std::size_t entries() const { return static_cast<std::size_t>(std::distance(fs::directory_iterator(path), {})); }
};

std::string contents(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

template <class Call>
std::string error_of(const Call& call) {
    try {
        call();
    } catch (const std::exception& error) { return error.what(); }
    return "";
}

std::string write_error(const std::string& path, const std::string& bytes = "new") {
    return error_of([&] { gaussmap::write_file(path, bytes); });
}

TEST(WriteFile, NewFilesHaveTheUsualPermissions) {
    const Folder folder;
    const mode_t mask = ::umask(027);
    gaussmap::write_file(folder.file("a"), "new");
    ::umask(mask);
    EXPECT_EQ(contents(folder.file("a")), "new");
    EXPECT_EQ(static_cast<int>(fs::status(folder.file("a")).permissions()), 0640);
    EXPECT_EQ(folder.entries(), 1u);
}

TEST(WriteFile, ReplacesAndKeepsPermissions) {
    const Folder folder;
    gaussmap::write_file(folder.file("a"), "old");
    ::chmod(folder.file("a").c_str(), 0604);
    gaussmap::write_file(folder.file("a"), "");
    EXPECT_EQ(contents(folder.file("a")), "");
    EXPECT_EQ(static_cast<int>(fs::status(folder.file("a")).permissions()), 0604);
}

TEST(WriteFile, GoesThroughLinks) {
    const Folder folder;
    fs::create_directory(folder.path / "d");
    gaussmap::write_file(folder.file("d/target"), "old");
    fs::create_symlink("d/target", folder.path / "one");
    fs::create_symlink("one", folder.path / "two");
    gaussmap::write_file(folder.file("two"), "new");
    EXPECT_EQ(contents(folder.file("d/target")), "new");
    EXPECT_TRUE(fs::is_symlink(folder.path / "two"));
    EXPECT_TRUE(fs::is_symlink(folder.path / "one"));
    fs::create_symlink("d/later", folder.path / "dangling");
    gaussmap::write_file(folder.file("dangling"), "made");
    EXPECT_EQ(contents(folder.file("d/later")), "made");
    fs::create_symlink("loop", folder.path / "loop");
    EXPECT_EQ(write_error(folder.file("loop")),
              folder.file("loop") + ": cannot write: Too many levels of symbolic links");
}

TEST(WriteFile, PipesAndDevicesAreWrittenAsTheyAre) {
    gaussmap::write_file("/dev/null", "new");
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
    EXPECT_EQ(write_error("/dev/full"),
              "/dev/full: cannot write: No space left on device; make room or write to another place");
    const Folder folder;
    ASSERT_EQ(::mkfifo(folder.file("pipe").c_str(), 0600), 0);
    std::string got;
    std::thread reader([&] { got = contents(folder.file("pipe")); });
    gaussmap::write_file(folder.file("pipe"), "through");
    reader.join();
    EXPECT_EQ(got, "through");
    fs::create_symlink("/dev/full", folder.path / "full");
    EXPECT_NE(write_error(folder.file("full")), "");
}

TEST(WriteFile, ErrorsNameThePathAndTheReason) {
    const Folder folder;
    EXPECT_EQ(write_error(folder.file("no/a")),
              folder.file("no/a") + ": cannot write: No such file or directory; make the folder first");
    gaussmap::write_file(folder.file("a"), "old");
    EXPECT_EQ(write_error(folder.file("a/b")),
              folder.file("a/b") + ": cannot write: Not a directory; make the folder first");
    EXPECT_EQ(write_error(folder.path.string()),
              folder.path.string() + ": cannot write: Is a directory; give the name of a file");
}

TEST(WriteFile, AFullDiskLeavesTheOldFile) {
    const Folder folder;
    gaussmap::write_file(folder.file("a"), "old");
    rlimit old_limit{};
    ::getrlimit(RLIMIT_FSIZE, &old_limit);
    const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{1 << 16, old_limit.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    const std::string error = write_error(folder.file("a"), std::string(1 << 20, 'n'));
    const std::string fresh = write_error(folder.file("b"), std::string(1 << 20, 'n'));
    ::setrlimit(RLIMIT_FSIZE, &old_limit);
    std::signal(SIGXFSZ, old_handler);
    EXPECT_EQ(error, folder.file("a") + ": cannot write: File too large; make room or write to another place");
    EXPECT_NE(fresh, "");
    EXPECT_EQ(contents(folder.file("a")), "old");
    EXPECT_EQ(folder.entries(), 1u);  // no new file, no part of one
}

/// A child that is told to stop while it writes; SIGXFSZ comes in the midst of it, where Ctrl-C might.
TEST(WriteFile, ASignalLeavesTheOldFile) {
    const Folder folder;
    gaussmap::write_file(folder.file("a"), "old");
    const pid_t child = ::fork();
    if (child == 0) {
        const rlimit limit{1 << 16, 1 << 16};
        ::setrlimit(RLIMIT_FSIZE, &limit);
        std::signal(SIGXFSZ, [](int) {
            gaussmap::remove_unfinished();
            ::_exit(42);
        });
        gaussmap::write_file(folder.file("a"), std::string(1 << 20, 'n'));
        ::_exit(0);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 42);
    EXPECT_EQ(contents(folder.file("a")), "old");
    EXPECT_EQ(folder.entries(), 1u);
    gaussmap::remove_unfinished();  // nothing under way: nothing to do
}

TEST(WriteFile, ManyAtOnce) {
    const Folder folder;
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t) {
        threads.emplace_back([&, t] {
            for (int i = 0; i < 50; ++i)
                gaussmap::write_file(folder.file("a"), std::string(1000, static_cast<char>('a' + t)));
        });
    }
    for (std::thread& thread : threads) thread.join();
    const std::string last = contents(folder.file("a"));
    EXPECT_EQ(last, std::string(1000, last[0]));
    EXPECT_EQ(folder.entries(), 1u);
}

TEST(Write, TheNameTellsTheFormat) {
    const Folder folder;
    gaussmap::Geometry g;
    g.vertices = {1, 2, 3};
    for (const char* name : {"a.PLY", "a.xyz", "a.pcd"}) {
        gaussmap::write(folder.file(name), g);
        EXPECT_EQ(gaussmap::read(folder.file(name)).vertices, g.vertices) << name;
    }
    gaussmap::write(folder.file("b"), g, {.format = Format::ply});
    EXPECT_EQ(gaussmap::read(folder.file("b")).vertices, g.vertices);
    for (const char* name : {"a.foo", "-", "ply"}) {
        EXPECT_EQ(error_of([&] { gaussmap::write(name, g); }),
                  std::string(name) + ": the name does not tell the format; give the format, or an extension among " +
                      gaussmap::known_extensions());
    }
    EXPECT_EQ(error_of([&] { gaussmap::write_bytes(g, {}); }), "write_bytes: the format is not given");
}

TEST(Read, FilesThatAreNone) {
    const Folder folder;
    const auto read_error = [](const std::string& path) { return error_of([&] { gaussmap::read(path); }); };
    EXPECT_EQ(read_error(folder.file("a.ply")),
              folder.file("a.ply") + ": cannot read: No such file or directory; check the path");
    EXPECT_EQ(read_error(folder.path.string()), folder.path.string() + ": is a folder; give the name of a file");
    EXPECT_EQ(read_error("/dev/zero"), "/dev/zero: is a device; give the name of a file");
    gaussmap::write_file(folder.file("e.ply"), "");
    EXPECT_EQ(read_error(folder.file("e.ply")), folder.file("e.ply") + ": the file is empty (0 bytes); write it anew");
    EXPECT_THROW(gaussmap::read(folder.file("e.ply")), gaussmap::FormatError);
}

TEST(Read, PipesAreReadToTheirEnd) {
    const Folder folder;
    ASSERT_EQ(::mkfifo(folder.file("pipe").c_str(), 0600), 0);
    std::string text =
        "ply\nformat ascii 1.0\nelement vertex 50000\nproperty float x\nproperty float y\nproperty float "
        "z\nend_header\n";
    for (int i = 0; i < 50000; ++i) text += "1 2 3\n";
    std::thread writer([&] { gaussmap::write_file(folder.file("pipe"), text); });
    EXPECT_EQ(gaussmap::read(folder.file("pipe")).vertex_count(), 50000u);
    writer.join();
}

TEST(Read, StandardInputFromWhereItStands) {
    const Folder folder;
    gaussmap::write_file(folder.file("a"), "junk\n1 2 3\n4 5 6\n");
    const int old = ::dup(STDIN_FILENO), file = ::open(folder.file("a").c_str(), O_RDONLY);
    ::lseek(file, 5, SEEK_SET);
    ::dup2(file, STDIN_FILENO);
    const gaussmap::Geometry g = gaussmap::read("-");
    ::dup2(old, STDIN_FILENO);
    ::close(old);
    ::close(file);
    EXPECT_EQ(g.vertices, (std::vector<double>{1, 2, 3, 4, 5, 6}));
}

}  // namespace
