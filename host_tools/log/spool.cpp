#include "spool.h"

#include "csv_text.h"
#include "ulog.h"
#include "write_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <limits>
#include <memory>

namespace traction::log {

namespace {

// The folder in which the log will stand, when it will be a file there.
std::string folder_of(const std::string &path) {
    struct stat there {};
    const bool in_place = path == "-" || (stat(path.c_str(), &there) == 0 && !S_ISREG(there.st_mode));
    if (in_place) return std::filesystem::temp_directory_path().string();
    const std::string folder = std::filesystem::path(path).parent_path().string();
    return folder.empty() ? "." : folder;
}

int unnamed_file(const std::string &folder) {
    const int fd = open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
    if (fd >= 0) return fd;
    std::string name = folder + "/.spool.XXXXXX"; // a file system without O_TMPFILE
    const int named = mkostemp(name.data(), O_CLOEXEC);
    if (named >= 0) unlink(name.c_str());
    return named;
}

} // namespace

Spool::Spool(std::string path) : path_(std::move(path)) {}

Spool::~Spool() {
    if (fd_ >= 0) close(fd_);
}

void Spool::fail() const {
    throw FileError(path_, 0, 0, std::string("cannot be written: ") + std::strerror(errno),
                    "give a path that can be, with space for the log twice");
}

std::size_t Spool::add(const std::string &name, bool absent_is_zero, std::size_t reserve) {
    Column fresh{.signal = {.name = name, .t_s = {}, .value = {}}, .blocks = {}, .absent_is_zero = absent_is_zero};
    fresh.signal.t_s.reserve(path_.empty() ? reserve : std::min(reserve, block));
    fresh.signal.value.reserve(path_.empty() ? reserve : std::min(reserve, block));
    columns_.push_back(std::move(fresh));
    return columns_.size() - 1;
}

void Spool::put(std::size_t column, double t_s, double value) {
    Column &to = columns_[column];
    to.signal.t_s.push_back(t_s);
    to.signal.value.push_back(value);
    to.all_zero = to.all_zero && value == 0;
    if (!path_.empty() && to.signal.value.size() == block) keep_block(to);
}

void Spool::keep_block(Column &column) {
    if (fd_ < 0) fd_ = unnamed_file(folder_of(path_));
    if (fd_ < 0) fail();
    column.blocks.push_back(end_);
    for (std::vector<double> *part : {&column.signal.t_s, &column.signal.value}) {
        const char *from = reinterpret_cast<const char *>(part->data());
        std::size_t left = part->size() * sizeof(double);
        while (left > 0) {
            const ssize_t done = pwrite(fd_, from, left, static_cast<off_t>(end_));
            if (done < 0 && errno == EINTR) continue;
            if (done <= 0) fail();
            from += done, left -= static_cast<std::size_t>(done), end_ += static_cast<std::uint64_t>(done);
        }
        part->clear();
    }
}

void Spool::load(const Column &column, std::size_t number, std::vector<double> &into) const {
    if (number >= column.blocks.size()) {
        into = column.signal.t_s;
        into.insert(into.end(), column.signal.value.begin(), column.signal.value.end());
        return;
    }
    into.resize(2 * block);
    char *to = reinterpret_cast<char *>(into.data());
    std::size_t left = into.size() * sizeof(double);
    std::uint64_t at = column.blocks[number];
    while (left > 0) {
        const ssize_t done = pread(fd_, to, left, static_cast<off_t>(at));
        if (done < 0 && errno == EINTR) continue;
        if (done <= 0) fail();
        to += done, left -= static_cast<std::size_t>(done), at += static_cast<std::uint64_t>(done);
    }
}

Log Spool::take() {
    Log result;
    for (Column &column : columns_)
        if (!column.left_out()) result.signals.push_back(std::move(column.signal));
    columns_.clear();
    return result;
}

// One column, sample after sample.
class Spool::Reader {
  public:
    Reader(const Spool &spool, const Column &column) : spool_(spool), column_(column) { open_block(); }
    double t_s() const { return at_ < size_ ? samples_[at_] : never; }
    double value() const { return samples_[size_ + at_]; }
    void next() {
        const double before = t_s();
        ++seen_;
        if (++at_ == size_) open_block();
        if (at_ < size_) check(before);
    }
    void check(double before) const {
        if (!(t_s() > before && t_s() < never && std::fabs(value()) < never)) refuse(before);
    }
    void refuse(double before) const { check_sample(column_.signal.name, seen_, before, t_s(), value(), spool_.path_); }

  private:
    void open_block() {
        at_ = size_ = 0;
        if (number_ > column_.blocks.size()) return;
        spool_.load(column_, number_++, samples_);
        size_ = samples_.size() / 2;
    }
    const Spool &spool_;
    const Column &column_;
    std::vector<double> samples_; // of one block: times, then values
    std::size_t number_ = 0, at_ = 0, size_ = 0, seen_ = 0;
};

// One column for the writer of ULog, which reads it twice.
class Spool::Again : public UlogColumn {
  public:
    Again(const Spool &spool, const Column &column) : spool_(spool), column_(column), reader_(std::make_unique<Reader>(spool, column)) {}
    const std::string &name() const override { return column_.signal.name; }
    void rewind() override { reader_ = std::make_unique<Reader>(spool_, column_); }
    double t_s() const override { return reader_->t_s(); }
    double value() const override { return reader_->value(); }
    void next() override { reader_->next(); }

  private:
    const Spool &spool_;
    const Column &column_;
    std::unique_ptr<Reader> reader_;
};

void Spool::write(const std::map<std::string, std::string> &header) {
    if (!names_a_ulog(path_)) {
        write_as_csv(header);
        return;
    }
    std::vector<std::unique_ptr<UlogColumn>> columns;
    for (const Column &column : columns_)
        if (!column.left_out()) columns.push_back(std::make_unique<Again>(*this, column));
    write_ulog(header, columns, path_);
}

// The rows of a log, column by column, straight into the file.
class Spool::Rows {
  public:
    Rows(WholeFile &file, std::vector<Reader> readers) : file_(file), readers_(std::move(readers)), shown_(readers_.size()) {
        for (const Reader &reader : readers_) next_.push_back(reader.t_s());
        room_ = (readers_.size() + 1) * (number_room + 1) + 1;
        text_.resize(std::max(2 * room_, std::size_t{1} << 20));
        to_ = text_.data();
    }
    void write() {
        while (take_due()) {
            put_row();
            // one column that is sampled more often than the rest: no search for the next row
            if (due_.size() != 1) continue;
            const std::size_t quick = due_.front();
            double others_s = never;
            for (std::size_t i = 0; i < next_.size(); ++i)
                if (i != quick) others_s = std::min(others_s, next_[i]);
            while (next_[quick] < others_s) now_s_ = next_[quick], put_row();
        }
        flush();
    }

  private:
    // What was last written in a column: most numbers stay what they were.
    struct Shown {
        std::uint64_t bits = 0;
        std::size_t size = 0;
        std::array<char, number_room> text{};
    };
    bool take_due() {
        now_s_ = never;
        for (const double t_s : next_) now_s_ = t_s < now_s_ ? t_s : now_s_;
        due_.clear();
        if (now_s_ == never) return false;
        for (std::size_t i = 0; i < next_.size(); ++i)
            if (next_[i] == now_s_) due_.push_back(i);
        return true;
    }
    void put_row() {
        if (static_cast<std::size_t>(text_.data() + text_.size() - to_) < room_) flush();
        to_ = put_number(to_, now_s_);
        std::size_t at = 0;
        for (const std::size_t i : due_) {
            commas(i + 1 - at);
            at = i + 1;
            Reader &reader = readers_[i];
            Shown &shown = shown_[i];
            const auto bits = std::bit_cast<std::uint64_t>(reader.value());
            if (bits != shown.bits || shown.size == 0) {
                shown.bits = bits;
                shown.size = static_cast<std::size_t>(put_number(shown.text.data(), reader.value()) - shown.text.data());
            }
            std::memcpy(to_, shown.text.data(), number_room); // as many bytes always: quicker, and there is room
            to_ += shown.size;
            reader.next();
            next_[i] = reader.t_s();
        }
        commas(readers_.size() - at);
        *to_++ = '\n';
    }
    void commas(std::size_t count) {
        if (count == 1) {
            *to_++ = ',';
            return;
        }
        std::memset(to_, ',', count);
        to_ += count;
    }
    void flush() {
        file_.write({text_.data(), static_cast<std::size_t>(to_ - text_.data())});
        to_ = text_.data();
    }

    WholeFile &file_;
    std::vector<Reader> readers_;
    std::vector<Shown> shown_;
    std::vector<double> next_; // time of each reader's next sample
    std::vector<std::size_t> due_;
    double now_s_ = never;
    std::vector<char> text_;
    std::size_t room_ = 0; // of a row
    char *to_ = nullptr;
};

void Spool::write_as_csv(const std::map<std::string, std::string> &header) {
    std::vector<std::string> names;
    std::vector<Reader> readers;
    for (const Column &column : columns_) {
        if (column.left_out()) continue;
        names.push_back(column.signal.name);
        readers.emplace_back(*this, column);
        readers.back().check(-never);
    }
    WholeFile file(path_);
    file.write(csv_head(header, names, path_));
    Rows(file, std::move(readers)).write();
    file.keep();
}

} // namespace traction::log
