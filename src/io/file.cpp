// Whole files in, and out so that a file is either the old one or the new one, never a part.
#include "io/file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <random>
#include <system_error>
#include <utility>

#include "gaussmap/io.h"

namespace gaussmap {

namespace {

/// An open file, closed at the end of its scope.
struct Descriptor {
    int fd = -1;
    bool owned = true;

    Descriptor(int number, bool ours) : fd(number), owned(ours) {}
    ~Descriptor() {
        if (owned && fd >= 0) ::close(fd);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;

    /// Close now, for the error that it may bring.
    bool close() { return ::close(std::exchange(fd, -1)) == 0; }
};

std::string reason(int error) {
    return std::generic_category().message(error);
}

[[noreturn]] void cannot_read(const std::string& path, int error) {
    const char* advice = error == ENOENT ? "; check the path" : error == EACCES ? "; check its permissions" : "";
    throw FormatError(path + ": cannot read: " + reason(error) + advice);
}

[[noreturn]] void cannot_write(const std::string& path, int error) {
    const char* advice = "";
    switch (error) {
        case ENOSPC:
        case EDQUOT:
        case EFBIG:
            advice = "; make room or write to another place";
            break;
        case ENOENT:
        case ENOTDIR:
            advice = "; make the folder first";
            break;
        case EISDIR:
            advice = "; give the name of a file";
            break;
        case EACCES:
        case EPERM:
        case EROFS:
            advice = "; choose a place you may write to";
            break;
        default:
            break;
    }
    throw std::runtime_error(path + ": cannot write: " + reason(error) + advice);
}

std::string read_to_end(int fd, const std::string& path) {
    std::string bytes;
    std::array<char, 1 << 16> part;
    while (true) {
        const ssize_t got = ::read(fd, part.data(), part.size());
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) cannot_read(path, errno);
        if (got == 0) return bytes;
        bytes.append(part.data(), static_cast<std::size_t>(got));
    }
}

/// 0, or the error that stopped it.
int write_all(int fd, std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t put = ::write(fd, bytes.data(), bytes.size());
        if (put < 0 && errno == EINTR) continue;
        if (put < 0) return errno;
        bytes.remove_prefix(static_cast<std::size_t>(put));
    }
    return 0;
}

/// The temporary file that a signal handler has to remove. It is never freed, so the handler may look at any moment.
struct Unfinished {
    std::array<char, 4096> path{};
    std::atomic<bool> taken{false}, set{false};
};
Unfinished unfinished;

/// A new file beside `target`, removed at the end of its scope unless it took the place of the target.
class Temporary {
  public:
    Temporary(const std::filesystem::path& target, mode_t mode) {
        std::random_device random;
        do {
            const std::uint64_t number = (std::uint64_t{random()} << 32) | random();
            std::array<char, 17> digits{};
            std::to_chars(digits.data(), digits.data() + 16, number, 16);
            path_ = (target.parent_path() / (std::string(".gaussmap-") + digits.data() + ".tmp")).string();
            announce();
            fd_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
            if (fd_ < 0) error_ = errno, withdraw();
        } while (fd_ < 0 && error_ == EEXIST);
    }
    ~Temporary() {
        if (fd_ >= 0) ::unlink(path_.c_str());
        withdraw();
    }
    Temporary(const Temporary&) = delete;
    Temporary& operator=(const Temporary&) = delete;

    int descriptor() const { return fd_; }
    int error() const { return error_; }
    bool replace(const std::filesystem::path& target) {
        if (::rename(path_.c_str(), target.c_str()) != 0) return false;
        fd_ = -1;
        return true;
    }

  private:
    // One file at a time is announced; a write in another thread at the same moment goes without.
    void announce() {
        if (path_.size() >= unfinished.path.size() || unfinished.taken.exchange(true)) return;
        announced_ = true;
        std::memcpy(unfinished.path.data(), path_.c_str(), path_.size() + 1);
        unfinished.set = true;
    }
    void withdraw() {
        if (!announced_) return;
        announced_ = false;
        unfinished.set = false;
        unfinished.taken = false;
    }

    std::string path_;
    int fd_ = -1, error_ = 0;
    bool announced_ = false;
};

/// Where a path leads when its links are followed, the last part existing or not.
std::filesystem::path follow_links(std::filesystem::path path) {
    for (int links = 0; links < 40 && std::filesystem::is_symlink(path); ++links) {
        path = path.parent_path() / std::filesystem::read_symlink(path);
    }
    return path;
}

/// A file that is no regular one (a pipe, a device), or is standard output: nothing can take its place.
void write_through(int fd, const std::string& path, std::string_view bytes) {
    Descriptor file(fd, fd != STDOUT_FILENO);
    if (fd < 0) cannot_write(path, errno);
    if (const int error = write_all(fd, bytes)) cannot_write(path, error);
    if (file.owned && !file.close()) cannot_write(path, errno);
}

/// `old` is what stands at the target, or null.
void replace_file(const std::string& path, const struct stat* old, std::string_view bytes) {
    if (old && ::access(path.c_str(), W_OK) != 0) cannot_write(path, errno);
    const std::filesystem::path target = follow_links(path);
    Temporary temporary(target, 0666);  // less the umask, as any new file
    if (temporary.descriptor() < 0) cannot_write(path, temporary.error());
    Descriptor file(temporary.descriptor(), true);
    if (old && ::fchmod(file.fd, old->st_mode & 07777) != 0) cannot_write(path, errno);
    if (const int error = write_all(file.fd, bytes)) cannot_write(path, error);
    if (!file.close()) cannot_write(path, errno);
    if (!temporary.replace(target)) cannot_write(path, errno);
}

}  // namespace

void write_file(const std::string& path, std::string_view bytes) {
    if (path == "-" || path == "/dev/stdout") return write_through(STDOUT_FILENO, path, bytes);
    struct stat status {};
    const bool exists = ::stat(path.c_str(), &status) == 0;
    if (!exists && errno != ENOENT) cannot_write(path, errno);
    if (exists && S_ISDIR(status.st_mode)) cannot_write(path, EISDIR);
    if (exists && !S_ISREG(status.st_mode)) {
        return write_through(::open(path.c_str(), O_WRONLY | O_CLOEXEC), path, bytes);
    }
    replace_file(path, exists ? &status : nullptr, bytes);
}

void remove_unfinished() noexcept {
    if (unfinished.set) ::unlink(unfinished.path.data());
}

namespace io {

FileBytes::FileBytes(const std::string& path) {
    const bool standard = path == "-";
    Descriptor file(standard ? STDIN_FILENO : ::open(path.c_str(), O_RDONLY | O_CLOEXEC), !standard);
    struct stat status {};
    if (file.fd < 0 || ::fstat(file.fd, &status) != 0) cannot_read(path, errno);
    if (S_ISDIR(status.st_mode)) throw FormatError(path + ": is a folder; give the name of a file");
    // A device may never end (/dev/zero); a terminal does, when its user says so.
    const bool device = S_ISBLK(status.st_mode) || (S_ISCHR(status.st_mode) && !::isatty(file.fd));
    if (device && !standard) throw FormatError(path + ": is a device; give the name of a file");
    const bool at_start = ::lseek(file.fd, 0, SEEK_CUR) == 0;
    if (S_ISREG(status.st_mode) && status.st_size > 0 && at_start) {
        const auto size = static_cast<std::size_t>(status.st_size);
        void* const address = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file.fd, 0);
        if (address != MAP_FAILED) {
            ::madvise(address, size, MADV_SEQUENTIAL);
            mapped_ = address;
            bytes_ = {static_cast<const char*>(address), size};
            return;
        }
    }
    read_ = read_to_end(file.fd, path);
    bytes_ = read_;
}

FileBytes::~FileBytes() {
    if (mapped_) ::munmap(mapped_, bytes_.size());
}

}  // namespace io

}  // namespace gaussmap
