// disk.h - a disk that loses its power: a storage_t in memory which knows what was brought to the disk and what was not.
//
// The power goes at the operation `cut_at` (counted from 0; a write keeps `torn` of its bytes first); from then on every operation fails
// and changes nothing. after_cut() is what such a disk may hold at the next start: each file that was not synced is as it was, as it is, a
// prefix of it, or that with zeros behind; each change of names in a folder that was not synced has happened or not. Names change
// atomically.
#pragma once

#include "firmware/flash/storage.h"

#include <cstdint>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

namespace flash {

enum class Kept { nothing, everything, by_chance };

class Disk {
  public:
    storage_t storage();

    Disk after_cut(Kept kept, std::mt19937 &chance) const;
    Disk copy() const; // with its own files

    std::map<std::string, std::string> files_in(const std::string &folder) const;
    void put(const std::string &path, const std::string &text); // as if from outside, synced
    void remove(const std::string &path);

    long operations = 0;  // so far
    long cut_at = -1;     // -1: never
    std::size_t torn = 0; // bytes of the write that is cut
    long fail_at = -1;    // this operation returns `error` and does nothing, the disk goes on
    int error = 0;        // a negative errno
    std::uint64_t free = 1u << 30;
    bool rots = false; // the last byte of every write comes out wrong

  private:
    struct File {
        std::string on_disk, now;
        bool synced = true;
    };
    using Names = std::map<std::string, std::shared_ptr<File>>;
    struct Change {                                                     // of a folder's names, all or nothing
        std::vector<std::pair<std::string, std::shared_ptr<File>>> set; // null: removed
    };
    struct Folder {
        Names on_disk, now;
        std::vector<Change> pending;
    };
    static std::pair<std::string, std::string> split(const std::string &path);
    int begin(); // 0, or why the next operation cannot be
    void change(const std::string &folder, Change change);
    std::shared_ptr<File> find(const std::string &path) const;

    std::map<std::string, Folder> folders_;
    std::vector<std::shared_ptr<File>> open_;
    friend struct Calls;
};

} // namespace flash
