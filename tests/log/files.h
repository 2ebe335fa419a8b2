// files.h - a file that lives as long as one test.
#pragma once

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <sstream>
#include <string>
#include <unistd.h>

namespace traction::test {

class File {
  public:
    File(const std::string &name, const std::string &text)
        : path_(::testing::TempDir() + "traction_" + std::to_string(::getpid()) + "_" + name) {
        std::ofstream(path_, std::ios::binary) << text;
    }
    ~File() { std::remove(path_.c_str()); }
    File(const File &) = delete;
    File &operator=(const File &) = delete;
    const std::string &path() const { return path_; }
    std::string text() const {
        std::ostringstream out;
        out << std::ifstream(path_, std::ios::binary).rdbuf();
        return out.str();
    }

  private:
    std::string path_;
};

} // namespace traction::test
