// The bytes of an input file. Writing is gaussmap::write_file.
#pragma once

#include <string>
#include <string_view>

namespace gaussmap::io {

/// A whole file: mapped into memory where that can be, else (a pipe, "-" for standard input) read to its end.
class FileBytes {
  public:
    /// \throw FormatError  the file is missing, a folder, a device, or cannot be read.
    explicit FileBytes(const std::string& path);
    ~FileBytes();
    FileBytes(const FileBytes&) = delete;
    FileBytes& operator=(const FileBytes&) = delete;

    std::string_view bytes() const { return bytes_; }

  private:
    std::string_view bytes_;
    std::string read_;  // holds the bytes that are not mapped
    void* mapped_ = nullptr;
};

}  // namespace gaussmap::io
