#include "spool.h"

#include "csv_text.h"
#include "ulog.h"

#include <algorithm>
#include <cmath>

namespace traction::log {

Spool::Spool(std::string path, Scratch::Name name) : path_(std::move(path)), scratch_(path_, name) {
    if (!path_.empty() && !names_a_ulog(path_)) rows_ = std::make_unique<RowSpool>(path_, name);
}

void Spool::begin(const std::map<std::string, std::string> &header) {
    if (rows_)
        rows_->begin(header);
    else
        header_ = header;
}

void Spool::put_by() {
    if (rows_)
        rows_->put_by();
    else if (!path_.empty())
        keep_blocks();
}

std::size_t Spool::add(const std::string &name, bool absent_is_zero, std::size_t reserve, Unit unit) {
    if (rows_) return rows_->add(name, absent_is_zero, unit);
    Column fresh{.signal = {.name = name, .t_s = {}, .value = {}}, .blocks = {}, .absent_is_zero = absent_is_zero, .unit = unit};
    fresh.signal.t_s.reserve(path_.empty() ? reserve : std::min(reserve, block));
    fresh.signal.value.reserve(path_.empty() ? reserve : std::min(reserve, block));
    columns_.push_back(std::move(fresh));
    return columns_.size() - 1;
}

std::size_t Spool::bind(const std::vector<std::size_t> &columns) {
    if (rows_) return rows_->bind(columns);
    bound_.push_back(columns);
    return bound_.size() - 1;
}

void Spool::put_in_columns(std::size_t bound, double t_s, const std::int32_t *whole, const Absent &absent, std::span<const Other> others) {
    for (std::size_t i = 0; i < bound_[bound].size(); ++i) {
        if (is_absent(absent, i)) continue;
        const std::size_t column = bound_[bound][i];
        const auto other = std::find_if(others.begin(), others.end(), [i](const Other &one) { return one.index == i; });
        put_in_column(column, t_s, other == others.end() ? value_of(columns_[column].unit, whole[i]) : other->value);
    }
}

void Spool::put_in_column(std::size_t column, double t_s, double value) {
    Column &to = columns_[column];
    to.signal.t_s.push_back(t_s);
    to.signal.value.push_back(value);
    to.all_zero = to.all_zero && value == 0;
    if (path_.empty() || to.signal.value.size() < block) return;
    full_ = true;
    if (to.signal.value.size() == 2 * block) keep_blocks();
}

// All columns at once, so that the part has them to one instant.
void Spool::keep_blocks() {
    full_ = false;
    std::vector<std::uint32_t> counts(1);
    for (std::size_t i = 0; i < columns_.size(); ++i)
        if (const std::size_t count = columns_[i].signal.value.size(); count > 0)
            counts.insert(counts.end(), {static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(count)});
    counts[0] = static_cast<std::uint32_t>(counts.size() / 2);
    if (counts[0] == 0) return;
    if (told_columns_ == 0) scratch_.append(part::Kind::header, part::header_text(header_));
    std::string names;
    for (; told_columns_ < columns_.size(); ++told_columns_)
        names +=
            part::column_line(columns_[told_columns_].signal.name, columns_[told_columns_].absent_is_zero, columns_[told_columns_].unit);
    if (!names.empty()) scratch_.append(part::Kind::columns, names);
    std::vector<std::string_view> pieces{part::bytes_of(counts)};
    for (const Column &column : columns_) {
        pieces.push_back(part::bytes_of(column.signal.t_s));
        pieces.push_back(part::bytes_of(column.signal.value));
    }
    std::uint64_t place = scratch_.append(part::Kind::samples, pieces) + pieces[0].size();
    for (Column &column : columns_) {
        const std::size_t count = column.signal.value.size();
        if (count == 0) continue;
        column.blocks.push_back({place, count});
        place += 2 * count * sizeof(double);
        column.signal.t_s.clear();
        column.signal.value.clear();
    }
}

void Spool::load(const Column &column, std::size_t number, std::vector<double> &into) const {
    if (number >= column.blocks.size()) {
        into = column.signal.t_s;
        into.insert(into.end(), column.signal.value.begin(), column.signal.value.end());
        return;
    }
    into.resize(2 * column.blocks[number].count);
    scratch_.read(column.blocks[number].place, into.data(), into.size() * sizeof(double));
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
    try {
        write_log(header);
    } catch (const FileError &error) {
        const std::string part = rows_ ? rows_->part() : scratch_.part();
        if (part.empty()) throw;
        const std::string said = error.what(), begins = error.file + ": "; // log.cpp
        const std::size_t from = said.starts_with(begins) ? begins.size() : 0;
        throw FileError(error.file, 0, 0, said.substr(from, said.rfind("; to mend: ") - from),
                        error.mend + "; what was recorded: traction recover " + part);
    }
}

void Spool::write_log(const std::map<std::string, std::string> &header) {
    if (rows_) {
        rows_->write(header);
        return;
    }
    std::vector<std::unique_ptr<UlogColumn>> columns;
    for (const Column &column : columns_)
        if (!column.left_out()) columns.push_back(std::make_unique<Again>(*this, column));
    write_ulog(header, columns, path_);
    scratch_.remove();
}

} // namespace traction::log
