#include "disk.h"

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace flash {

std::pair<std::string, std::string> Disk::split(const std::string &path) {
    const std::size_t slash = path.rfind('/');
    return {path.substr(0, slash), path.substr(slash + 1)};
}

int Disk::begin() {
    const long number = operations++;
    if (cut_at >= 0 && number >= cut_at) return -EIO;
    return number == fail_at ? error : 0;
}

std::shared_ptr<Disk::File> Disk::find(const std::string &path) const {
    const auto [folder, name] = split(path);
    const auto in = folders_.find(folder);
    if (in == folders_.end()) return nullptr;
    const auto at = in->second.now.find(name);
    return at == in->second.now.end() ? nullptr : at->second;
}

void Disk::change(const std::string &folder, Change change) {
    Folder &in = folders_[folder];
    for (const auto &[name, file] : change.set) {
        if (file)
            in.now[name] = file;
        else
            in.now.erase(name);
    }
    in.pending.push_back(std::move(change));
}

Disk Disk::copy() const {
    std::map<const File *, std::shared_ptr<File>> again;
    const auto own = [&](const std::shared_ptr<File> &file) {
        auto &made = again[file.get()];
        if (file && !made) made = std::make_shared<File>(*file);
        return made;
    };
    Disk disk;
    disk.free = free;
    for (const auto &[path, folder] : folders_) {
        Folder &in = disk.folders_[path];
        for (const auto &[name, file] : folder.on_disk) in.on_disk[name] = own(file);
        for (const auto &[name, file] : folder.now) in.now[name] = own(file);
        for (const Change &change : folder.pending) {
            in.pending.emplace_back();
            for (const auto &[name, file] : change.set) in.pending.back().set.emplace_back(name, own(file));
        }
    }
    return disk;
}

Disk Disk::after_cut(Kept kept, std::mt19937 &chance) const {
    Disk disk = copy();
    const auto toss = [&] { return kept == Kept::everything || (kept == Kept::by_chance && chance() % 2 == 0); };
    std::map<File *, bool> settled;
    const auto settle = [&](const std::shared_ptr<File> &file) {
        if (!file || file->synced || settled[file.get()]) return;
        settled[file.get()] = true;
        std::string left = file->on_disk;
        if (kept == Kept::everything) left = file->now;
        if (kept == Kept::by_chance) {
            const auto way = chance() % 4;
            const std::size_t some = file->now.empty() ? 0 : chance() % (file->now.size() + 1);
            if (way == 1) left = file->now;
            if (way >= 2) left = file->now.substr(0, some);
            if (way == 3) left.resize(file->now.size(), '\0'); // the length came to the disk, the bytes did not
        }
        *file = File{left, left, true};
    };
    for (auto &[path, folder] : disk.folders_) {
        for (const Change &change : folder.pending) {
            if (!toss()) continue;
            for (const auto &[name, file] : change.set) {
                if (file)
                    folder.on_disk[name] = file;
                else
                    folder.on_disk.erase(name);
            }
        }
        folder.pending.clear();
        folder.now = folder.on_disk;
        for (auto &[name, file] : folder.now) settle(file);
    }
    return disk;
}

std::map<std::string, std::string> Disk::files_in(const std::string &folder) const {
    std::map<std::string, std::string> files;
    if (const auto in = folders_.find(folder); in != folders_.end())
        for (const auto &[name, file] : in->second.now) files[name] = file->now;
    return files;
}

void Disk::put(const std::string &path, const std::string &text) {
    const auto [folder, name] = split(path);
    const auto file = std::make_shared<File>(File{text, text, true});
    folders_[folder].now[name] = folders_[folder].on_disk[name] = file;
}

void Disk::remove(const std::string &path) {
    const auto [folder, name] = split(path);
    folders_[folder].now.erase(name);
    folders_[folder].on_disk.erase(name);
}

struct Calls {
    static Disk &disk(void *context) { return *static_cast<Disk *>(context); }

    static long read(void *context, const char *path, long offset, void *bytes, std::size_t room) {
        const auto file = disk(context).find(path);
        if (!file) return -ENOENT;
        if (static_cast<std::size_t>(offset) >= file->now.size()) return 0;
        const std::size_t length = std::min(room, file->now.size() - static_cast<std::size_t>(offset));
        std::memcpy(bytes, file->now.data() + offset, length);
        return static_cast<long>(length);
    }
    static int create(void *context, const char *path, std::uint32_t) {
        Disk &d = disk(context);
        if (const int no = d.begin()) return no;
        const auto [folder, name] = Disk::split(path);
        if (d.folders_.find(folder) == d.folders_.end()) return -ENOENT;
        auto file = d.find(path);
        if (!file) {
            file = std::make_shared<Disk::File>();
            Disk::Change made;
            made.set.emplace_back(name, file);
            d.change(folder, made);
        }
        file->now.clear();
        file->synced = false;
        d.open_.push_back(file);
        return static_cast<int>(d.open_.size()) - 1;
    }
    static int write(void *context, int handle, const void *bytes, std::size_t length) {
        Disk &d = disk(context);
        Disk::File &file = *d.open_[static_cast<std::size_t>(handle)];
        const bool here = d.operations == d.cut_at;
        const int no = d.begin();
        if (no != 0) {
            if (here) file.now.append(static_cast<const char *>(bytes), std::min(d.torn, length)); // torn
            return no;
        }
        if (d.free < length) return -ENOSPC;
        d.free -= length;
        file.now.append(static_cast<const char *>(bytes), length);
        if (d.rots && length > 0) file.now.back() = static_cast<char>(file.now.back() ^ 1);
        file.synced = false;
        return 0;
    }
    static int sync(void *context, int handle) {
        Disk &d = disk(context);
        if (const int no = d.begin()) return no;
        Disk::File &file = *d.open_[static_cast<std::size_t>(handle)];
        file.on_disk = file.now;
        file.synced = true;
        return 0;
    }
    static int close(void *context, int) { return disk(context).begin(); }
    static int sync_folder(void *context, const char *path) {
        Disk &d = disk(context);
        if (const int no = d.begin()) return no;
        const auto in = d.folders_.find(path);
        if (in == d.folders_.end()) return -ENOENT;
        in->second.on_disk = in->second.now;
        in->second.pending.clear();
        return 0;
    }
    static int rename(void *context, const char *from, const char *to) {
        Disk &d = disk(context);
        if (const int no = d.begin()) return no;
        const auto file = d.find(from);
        if (!file) return -ENOENT;
        const auto [folder, old_name] = Disk::split(from);
        Disk::Change change;
        change.set.emplace_back(old_name, nullptr);
        change.set.emplace_back(Disk::split(to).second, file);
        d.change(folder, change);
        return 0;
    }
    static int unlink(void *context, const char *path) {
        Disk &d = disk(context);
        if (const int no = d.begin()) return no;
        if (!d.find(path)) return -ENOENT;
        const auto [folder, name] = Disk::split(path);
        Disk::Change gone;
        gone.set.emplace_back(name, nullptr);
        d.change(folder, gone);
        return 0;
    }
    static int make_folder(void *context, const char *path) {
        Disk &d = disk(context);
        if (const int no = d.begin()) return no;
        d.folders_[path];
        return 0;
    }
    static int list(void *context, const char *path, int (*each)(void *, const char *, std::uint64_t), void *visitor) {
        Disk &d = disk(context);
        const auto in = d.folders_.find(path);
        if (in == d.folders_.end()) return -ENOENT;
        int result = 0;
        for (const auto &[name, text] : d.files_in(path))
            if (result == 0) result = each(visitor, name.c_str(), text.size());
        return result;
    }
    static int room(void *context, const char *, std::uint64_t *bytes) {
        *bytes = disk(context).free;
        return 0;
    }
};

storage_t Disk::storage() {
    storage_t s{};
    s.context = this;
    s.read = Calls::read;
    s.create = Calls::create;
    s.write = Calls::write;
    s.sync = Calls::sync;
    s.close = Calls::close;
    s.sync_folder = Calls::sync_folder;
    s.rename = Calls::rename;
    s.unlink = Calls::unlink;
    s.make_folder = Calls::make_folder;
    s.list = Calls::list;
    s.room = Calls::room;
    return s;
}

} // namespace flash
