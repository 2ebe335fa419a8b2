// Packages that are refused, and two slots whose power is cut at every operation: the old version or the new one runs, whole.
#include "disk.h"

#include "firmware/flash/slots.h"

#include <cstdio>
#include <gtest/gtest.h>
#include <tuple>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <random>
#include <string>
#include <vector>

using flash::Disk;
using flash::Kept;

namespace {

const std::string root = "/board";
constexpr bool emulated = sizeof(void *) == 4; // the target under qemu-arm, thirty times as slow: the same claims on fewer cases

// A small tree, 32 packages: as good a signature for what is asked here.
struct Signer {
    explicit Signer(std::uint8_t first) : nodes(64) {
        secret.tree = 5;
        secret.once = 3;
        secret.id[0] = secret.seed[0] = first;
        EXPECT_TRUE(lms_grow(&secret, reinterpret_cast<std::uint8_t(*)[SHA256_BYTES]>(nodes.data()), key));
    }
    std::string sign(std::uint32_t q, const std::string &message) {
        std::uint8_t random[SHA256_BYTES] = {7};
        std::string signature(LMS_SIGNATURE, '\0');
        signature.resize(lms_sign(&secret, reinterpret_cast<std::uint8_t(*)[SHA256_BYTES]>(nodes.data()), q, random, message.data(),
                                  message.size(), reinterpret_cast<std::uint8_t *>(signature.data())));
        return signature;
    }
    lms_secret_t secret{};
    std::vector<std::array<std::uint8_t, SHA256_BYTES>> nodes;
    std::uint8_t key[LMS_PUBLIC] = {};
};

Signer &owner() {
    static Signer signer(1);
    return signer;
}

using Files = std::vector<std::pair<std::string, std::string>>;

Files version(const std::string &word) {
    std::string program(9001, '\0'); // more than two writes
    for (std::size_t i = 0; i < program.size(); i++) program[i] = static_cast<char>(i * 31 + word.size() + static_cast<unsigned>(word[0]));
    return {{"tractiond", program}, {"start", "#!/bin/sh\n# " + word + "\n"}, {"empty", ""}};
}

void add(std::string &archive, const std::string &name, std::uint32_t mode, const std::string &contents) {
    std::uint8_t block[PACKAGE_BLOCK];
    ASSERT_TRUE(package_header(name.c_str(), mode, static_cast<std::uint32_t>(contents.size()), block));
    archive.append(reinterpret_cast<const char *>(block), sizeof block);
    archive += contents + std::string(package_padding(static_cast<std::uint32_t>(contents.size())), '\0');
}

struct Wanted {
    Files files;
    std::uint32_t number = 0;
    std::string rover = "Traveller", architecture = "armel";
    bool is_signed = true;
};

std::string pack(const Wanted &wanted, Signer &signer = owner()) {
    package_t package{};
    std::strcpy(package.version, "0.2.0");
    std::strcpy(package.commit, "f486e7d123");
    std::strcpy(package.architecture, wanted.architecture.c_str());
    std::strcpy(package.rover, wanted.rover.c_str());
    std::memcpy(package.key, signer.secret.id, LMS_ID);
    package.number = wanted.number;
    package.count = static_cast<std::uint32_t>(wanted.files.size());
    for (std::size_t i = 0; i < wanted.files.size(); i++) {
        const auto &[name, contents] = wanted.files[i];
        std::strcpy(package.file[i].name, name.c_str());
        package.file[i].mode = i < 2 ? 0755 : 0644;
        package.file[i].size = static_cast<std::uint32_t>(contents.size());
        sha256(contents.data(), contents.size(), package.file[i].sha);
    }
    char text[PACKAGE_TEXT];
    const std::string manifest(text, package_print_manifest(&package, text));
    EXPECT_FALSE(manifest.empty());
    std::string archive;
    add(archive, "manifest", 0644, manifest);
    add(archive, "manifest.sig", 0644, wanted.is_signed ? signer.sign(wanted.number, manifest) : "");
    for (std::size_t i = 0; i < wanted.files.size(); i++) add(archive, wanted.files[i].first, i < 2 ? 0755 : 0644, wanted.files[i].second);
    return archive + std::string(2 * PACKAGE_BLOCK, '\0');
}

struct Board {
    explicit Board(Disk &on) : disk(on) {
        slots.storage = on.storage();
        slots.folder = root.c_str();
        slots.architecture = "armel";
        slots.self_test = [](void *context, const char *, char *why) {
            std::strcpy(why, "the hash is another");
            return static_cast<Board *>(context)->unfit ? 1 : 0;
        };
        slots.context = this;
    }
    slots_result_t install(const std::string &package, bool check_only = false) {
        return slots_install(&slots, reinterpret_cast<const std::uint8_t *>(package.data()), package.size(), check_only, message);
    }
    slots_result_t start() { return slots_start(&slots, &slot, &on_trial, message); }
    slots_result_t confirm() { return slots_confirm(&slots, message); }
    slots_result_t give_up(const char *why) { return slots_return(&slots, why, message); }
    slots_state_t state() {
        slots_state_t found;
        slots_state(&slots, &found);
        return found;
    }
    // The files of the slot that start() chose are these.
    bool runs(const Files &files) const {
        if (slot != SLOT_A && slot != SLOT_B) return false;
        const auto there = disk.files_in(root + (slot == SLOT_A ? "/a" : "/b"));
        return std::all_of(files.begin(), files.end(), [&](const auto &file) {
            const auto at = there.find(file.first);
            return at != there.end() && at->second == file.second;
        });
    }
    Disk &disk;
    slots_t slots{};
    bool unfit = false, on_trial = false;
    int slot = SLOT_NONE;
    char message[PACKAGE_MESSAGE] = "";
};

// A board on which `old` was confirmed as number 3, in slot a.
Disk board_with(const Files &old) {
    Disk disk;
    Board board(disk);
    EXPECT_EQ(slots_init(&board.slots, owner().key, "Traveller", board.message), SLOTS_DONE) << board.message;
    EXPECT_EQ(board.install(pack({.files = old, .number = 3})), SLOTS_DONE) << board.message;
    EXPECT_EQ(board.start(), SLOTS_DONE);
    EXPECT_TRUE(board.on_trial);
    EXPECT_EQ(board.confirm(), SLOTS_DONE);
    return disk;
}

const Files old_version = version("old"), new_version = version("the new one"), next_version = version("yet another");

void expect_old_runs(Board &board, const std::string &what) {
    ASSERT_EQ(board.start(), SLOTS_DONE) << what << ": " << board.message;
    EXPECT_TRUE(board.runs(old_version)) << what;
    EXPECT_FALSE(board.on_trial) << what;
}

} // namespace

TEST(slots, a_new_version_is_tried_and_confirmed) {
    Disk disk = board_with(old_version);
    Board board(disk);
    expect_old_runs(board, "before");
    ASSERT_EQ(board.install(pack({.files = new_version, .number = 4}), true), SLOTS_DONE) << board.message; // looked at only
    expect_old_runs(board, "looked at");
    ASSERT_EQ(board.install(pack({.files = new_version, .number = 4})), SLOTS_DONE) << board.message;
    ASSERT_EQ(board.start(), SLOTS_DONE);
    EXPECT_TRUE(board.on_trial && board.runs(new_version));
    ASSERT_EQ(board.confirm(), SLOTS_DONE);
    ASSERT_EQ(board.start(), SLOTS_DONE);
    EXPECT_TRUE(!board.on_trial && board.runs(new_version));
    EXPECT_STREQ(board.state().note, "confirmed 4");
    EXPECT_EQ(board.install(pack({.files = new_version, .number = 4})), SLOTS_SAME);
}

TEST(slots, a_trial_that_nobody_confirms_is_given_up_after_its_starts) {
    Disk disk = board_with(old_version);
    Board board(disk);
    ASSERT_EQ(board.install(pack({.files = new_version, .number = 4})), SLOTS_DONE);
    for (int i = 0; i < SLOTS_TRIES; i++) {
        ASSERT_EQ(board.start(), SLOTS_DONE);
        EXPECT_TRUE(board.on_trial && board.runs(new_version)) << i;
    }
    expect_old_runs(board, "after the tries");
    EXPECT_STREQ(board.state().note, "returned 4: started several times, never healthy");
    ASSERT_EQ(board.install(pack({.files = new_version, .number = 4})), SLOTS_DONE) << board.message; // again is allowed
}

TEST(slots, a_trial_that_is_unhealthy_returns_and_is_never_started_again) {
    Disk disk = board_with(old_version);
    Board board(disk);
    ASSERT_EQ(board.install(pack({.files = new_version, .number = 4})), SLOTS_DONE);
    ASSERT_EQ(board.start(), SLOTS_DONE);
    ASSERT_EQ(board.give_up("faults\n00000010"), SLOTS_DONE);
    EXPECT_STREQ(board.state().note, "returned 4: faults 00000010");
    expect_old_runs(board, "returned");
    disk.remove(root + "/a/tractiond"); // the good one is damaged: the one that failed is not taken for it
    EXPECT_EQ(board.start(), SLOTS_EMPTY);
}

TEST(slots, what_is_refused_leaves_the_old_version_and_writes_nothing) {
    Signer stranger(2);
    Signer same_name(3);
    std::memcpy(same_name.secret.id, owner().secret.id, LMS_ID);
    ASSERT_TRUE(lms_grow(&same_name.secret, reinterpret_cast<std::uint8_t(*)[SHA256_BYTES]>(same_name.nodes.data()), same_name.key));
    const std::string good = pack({.files = new_version, .number = 4});
    const std::vector<std::tuple<std::string, std::string, std::string>> cases = {
        {"rover", pack({.files = new_version, .number = 4, .rover = "Other"}), "for the rover Other, this is Traveller"},
        {"architecture", pack({.files = new_version, .number = 4, .architecture = "amd64"}), "for the architecture amd64, this is armel"},
        {"unsigned", pack({.files = new_version, .number = 4, .is_signed = false}), "not signed"},
        {"stranger", pack({.files = new_version, .number = 4}, stranger), "and this rover obeys the key 01000000"},
        {"same name", pack({.files = new_version, .number = 4}, same_name), "signature is not by the key"},
        {"older", pack({.files = new_version, .number = 2}), "number 2 is not above 3"},
        {"index used twice", pack({.files = new_version, .number = 3}), "number 3 is not above 3"},
        {"nothing", "", "none at all"},
        {"something else", std::string(5000, 'x'), "none at all"},
        {"something behind", good + std::string(PACKAGE_BLOCK, '\0'), "its end"},
    };
    for (const auto &[what, package, words] : cases) {
        Disk disk = board_with(old_version);
        Board board(disk);
        const long before = disk.operations;
        EXPECT_EQ(board.install(package), SLOTS_REFUSED) << what;
        EXPECT_NE(std::string(board.message).find(words), std::string::npos) << what << ": " << board.message;
        EXPECT_EQ(disk.operations, before) << what;
        expect_old_runs(board, what);
    }
}

TEST(slots, no_byte_of_a_package_can_be_changed_and_none_be_missing) {
    Disk disk = board_with(old_version);
    Board board(disk);
    const std::string good = pack({.files = new_version, .number = 4});
    ASSERT_EQ(board.install(good, true), SLOTS_DONE);
    const long before = disk.operations;
    std::mt19937 chance(20261123);
    std::string bad = good;
    for (std::size_t i = 0; i < bad.size(); i += emulated   ? 61
                                                 : i < 4608 ? 1
                                                            : 7) { // headers, manifest, signature: each byte; contents: each seventh
        const char was = bad[i];
        bad[i] = static_cast<char>(was ^ (1 << chance() % 8));
        ASSERT_EQ(board.install(bad, true), SLOTS_REFUSED) << i;
        bad[i] = was;
    }
    for (std::size_t length = 0; length < good.size(); length += emulated ? 331 : length < 600 ? 1 : 97)
        ASSERT_EQ(board.install(good.substr(0, length), true), SLOTS_REFUSED) << length;
    EXPECT_EQ(disk.operations, before);
}

TEST(slots, a_version_that_fails_its_self_test_is_not_put_on_trial) {
    Disk disk = board_with(old_version);
    Board board(disk);
    board.unfit = true;
    EXPECT_EQ(board.install(pack({.files = new_version, .number = 4})), SLOTS_UNFIT);
    EXPECT_NE(std::string(board.message).find("self-test on this board: the hash is another"), std::string::npos);
    expect_old_runs(board, "unfit");
    board.unfit = false;
    EXPECT_EQ(board.install(pack({.files = new_version, .number = 4})), SLOTS_DONE);
}

TEST(slots, nothing_is_installed_over_the_way_back_while_a_trial_runs) {
    Disk disk = board_with(old_version);
    Board board(disk);
    ASSERT_EQ(board.install(pack({.files = new_version, .number = 4})), SLOTS_DONE);
    EXPECT_EQ(board.install(pack({.files = next_version, .number = 5})), SLOTS_BUSY);
    ASSERT_EQ(board.give_up("by hand"), SLOTS_DONE);
    expect_old_runs(board, "by hand");
}

TEST(slots, a_full_disk_is_told_before_anything_is_written) {
    Disk disk = board_with(old_version);
    Board board(disk);
    disk.free = 70000; // kB are told rounded down
    const long before = disk.operations;
    EXPECT_EQ(board.install(pack({.files = new_version, .number = 4})), SLOTS_FULL);
    EXPECT_NE(std::string(board.message).find("are needed, 68 kB are free"), std::string::npos) << board.message;
    EXPECT_EQ(disk.operations, before);
    expect_old_runs(board, "full");
}

TEST(slots, what_does_not_read_back_is_not_put_on_trial_and_nothing_old_is_left_behind) {
    Disk disk = board_with(old_version);
    Board board(disk);
    disk.rots = true;
    EXPECT_EQ(board.install(pack({.files = new_version, .number = 4})), SLOTS_BROKEN);
    EXPECT_NE(std::string(board.message).find("does not read back"), std::string::npos) << board.message;
    disk.rots = false;
    expect_old_runs(board, "rots");
    disk.put(root + "/b/left_behind", std::string(5000, 'x'));
    ASSERT_EQ(board.install(pack({.files = new_version, .number = 4})), SLOTS_DONE);
    EXPECT_EQ(disk.files_in(root + "/b").size(), new_version.size() + 2); // manifest and signature
}

TEST(slots, a_damaged_slot_is_never_started_and_a_lost_state_finds_the_version_that_was_good) {
    for (const char *name : {"tractiond", "start", "empty", "manifest"}) {
        Disk disk = board_with(old_version);
        Board board(disk);
        ASSERT_EQ(board.install(pack({.files = new_version, .number = 4})), SLOTS_DONE);
        disk.put(root + "/b/" + name, "rust");
        expect_old_runs(board, name);
        ASSERT_EQ(board.install(pack({.files = new_version, .number = 4})), SLOTS_DONE) << board.message;
        ASSERT_EQ(board.start(), SLOTS_DONE);
        ASSERT_EQ(board.confirm(), SLOTS_DONE);
        disk.put(root + "/b/" + name, "rust"); // the good one: the one before it is whole
        expect_old_runs(board, name);
        ASSERT_EQ(board.install(pack({.files = next_version, .number = 5})), SLOTS_DONE) << board.message; // over the damaged one
        EXPECT_EQ(disk.files_in(root + "/b").at("start"), next_version[1].second);
    }
    for (const char *text : {"", "rust", "traction-slots 1\ngood b 9 00\n"}) {
        Disk disk = board_with(old_version);
        Board board(disk);
        ASSERT_EQ(board.install(pack({.files = new_version, .number = 4})), SLOTS_DONE);
        disk.put(root + "/state", text);
        expect_old_runs(board, text);
    }
    Disk disk = board_with(old_version);
    Board board(disk);
    const std::string state = disk.files_in(root).at("state");
    for (std::size_t i = 0; i < state.size(); i++) { // no byte of it is believed that was not written so
        std::string changed = state;
        changed[i] = static_cast<char>(changed[i] ^ 1);
        disk.put(root + "/state", changed);
        EXPECT_STREQ(board.state().note, "the state was lost; taken from the slots") << i;
        expect_old_runs(board, changed);
    }
}

// Operation by operation: before it, after it, and in a write after each of some bytes; and what was not synced is lost, kept, or both.
TEST(slots, the_power_may_go_at_every_operation) {
    const std::string package = pack({.files = new_version, .number = 4}), next = pack({.files = next_version, .number = 5});
    const Disk before = board_with(old_version);
    std::mt19937 chance(20261123);
    long cuts = 0, starts = 0, old_ones = 0, new_ones = 0;
    for (long cut = 0; cut >= 0; cut++) {
        for (const std::size_t torn : emulated ? std::vector<std::size_t>{100u} : std::vector<std::size_t>{0u, 1u, 100u, 4095u, 4096u}) {
            Disk disk = before.copy();
            Board board(disk);
            disk.cut_at = cut;
            disk.torn = torn;
            const bool done = board.install(package) == SLOTS_DONE && board.start() == SLOTS_DONE && board.confirm() == SLOTS_DONE;
            if (done && disk.operations <= cut) { // the whole way needs no more operations
                cut = -2;
                break;
            }
            cuts++;
            for (int way = 0; way < (emulated ? 3 : 12); way++, starts++) {
                Disk later = disk.after_cut(way == 0 ? Kept::nothing : way == 1 ? Kept::everything : Kept::by_chance, chance);
                Board again(later);
                ASSERT_EQ(again.start(), SLOTS_DONE) << cut << ' ' << torn << ' ' << way << ": " << again.message;
                const bool is_new = again.runs(new_version);
                ASSERT_TRUE(is_new || again.runs(old_version)) << cut << ' ' << torn << ' ' << way;
                (is_new ? new_ones : old_ones)++;
                ASSERT_STRNE(again.state().note, "the state was lost; taken from the slots") << cut << ' ' << torn << ' ' << way;
                // and flashed once more, it runs what it was given
                if (again.on_trial) {
                    ASSERT_EQ(again.confirm(), SLOTS_DONE);
                }
                ASSERT_EQ(again.install(next), SLOTS_DONE) << cut << ' ' << torn << ' ' << way << ": " << again.message;
                ASSERT_EQ(again.start(), SLOTS_DONE);
                ASSERT_TRUE(again.on_trial && again.runs(next_version)) << cut << ' ' << torn << ' ' << way;
                ASSERT_EQ(again.confirm(), SLOTS_DONE);
                ASSERT_EQ(again.start(), SLOTS_DONE);
                ASSERT_TRUE(!again.on_trial && again.runs(next_version));
            }
        }
    }
    EXPECT_GT(cuts, emulated ? 30 : 150); // 30 operations and more, 5 ways to tear
    EXPECT_GT(old_ones, starts / 3);
    EXPECT_GT(new_ones, starts / 8);
    std::printf("%ld cuts, %ld starts after them: %ld times the old version, %ld times the new one\n", cuts, starts, old_ones, new_ones);
}

// What was told as done survives whatever happens to what was not brought to the disk.
TEST(slots, what_was_reported_done_is_on_the_disk) {
    std::mt19937 chance(20261126);
    for (int way = 0; way < (emulated ? 4 : 40); way++) {
        const Kept kept = way == 0 ? Kept::nothing : way == 1 ? Kept::everything : Kept::by_chance;
        Disk disk = board_with(old_version);
        Board board(disk);
        ASSERT_EQ(board.install(pack({.files = new_version, .number = 4})), SLOTS_DONE);
        Disk installed = disk.after_cut(kept, chance);
        Board second(installed);
        ASSERT_EQ(second.start(), SLOTS_DONE);
        ASSERT_TRUE(second.on_trial && second.runs(new_version)) << way;
        Disk started = installed.after_cut(kept, chance);
        Board third(started);
        ASSERT_EQ(third.state().tries, 1u) << way; // counted before it runs
        ASSERT_EQ(second.confirm(), SLOTS_DONE);
        Disk confirmed = installed.after_cut(kept, chance);
        Board fourth(confirmed);
        ASSERT_EQ(fourth.start(), SLOTS_DONE);
        ASSERT_TRUE(!fourth.on_trial && fourth.runs(new_version)) << way;
        ASSERT_EQ(third.give_up("faults"), SLOTS_DONE);
        Disk returned = started.after_cut(kept, chance);
        Board fifth(returned);
        expect_old_runs(fifth, "returned");
        ASSERT_STREQ(fifth.state().note, "returned 4: faults");
    }
}

// The way back, cut likewise: unhealthy, returned, started.
TEST(slots, the_power_may_go_at_every_operation_of_the_way_back) {
    Disk before = board_with(old_version);
    {
        Board board(before);
        ASSERT_EQ(board.install(pack({.files = new_version, .number = 4})), SLOTS_DONE);
    }
    std::mt19937 chance(20261124);
    for (long cut = 0; cut >= 0; cut++) {
        for (const std::size_t torn : emulated ? std::vector<std::size_t>{100u} : std::vector<std::size_t>{0u, 1u, 100u}) {
            Disk disk = before.copy();
            Board board(disk);
            disk.cut_at = cut;
            disk.torn = torn;
            const bool done = board.start() == SLOTS_DONE && board.give_up("faults") == SLOTS_DONE && board.start() == SLOTS_DONE;
            if (done && disk.operations <= cut) {
                cut = -2;
                break;
            }
            for (int way = 0; way < (emulated ? 3 : 12); way++) {
                Disk later = disk.after_cut(way == 0 ? Kept::nothing : way == 1 ? Kept::everything : Kept::by_chance, chance);
                Board again(later);
                int tries = 0;
                do { // a return that the cut has eaten is found again, at the latest by the count of starts
                    ASSERT_EQ(again.start(), SLOTS_DONE) << cut << ' ' << torn << ' ' << way << ": " << again.message;
                    ASSERT_TRUE(again.runs(again.on_trial ? new_version : old_version)) << cut << ' ' << torn << ' ' << way;
                } while (again.on_trial && ++tries <= SLOTS_TRIES);
                ASSERT_FALSE(again.on_trial) << cut;
                ASSERT_EQ(again.install(pack({.files = next_version, .number = 5})), SLOTS_DONE) << again.message;
            }
        }
    }
}

// Every operation may fail for its own reasons, the disk full or broken: told, and the old version runs, or the new one is whole.
TEST(slots, every_operation_may_fail) {
    const std::string package = pack({.files = new_version, .number = 4});
    const Disk before = board_with(old_version);
    for (const int error : {-ENOSPC, -EIO, -EROFS}) {
        for (long fail = 0;; fail++) {
            Disk disk = before.copy();
            Board board(disk);
            disk.fail_at = fail;
            disk.error = error;
            const slots_result_t result = board.install(package);
            if (disk.operations <= fail) break;
            ASSERT_TRUE(result == SLOTS_DONE || result == (error == -ENOSPC ? SLOTS_FULL : SLOTS_BROKEN)) << fail;
            if (result != SLOTS_DONE) {
                ASSERT_NE(std::string(board.message).find(std::strerror(-error)), std::string::npos) << board.message;
            }
            ASSERT_EQ(board.start(), SLOTS_DONE) << fail << ": " << board.message;
            ASSERT_TRUE(board.runs(board.on_trial ? new_version : old_version)) << fail;
            if (result == SLOTS_DONE) {
                ASSERT_TRUE(board.on_trial) << fail;
            }
        }
    }
}

TEST(package, a_manifest_is_read_as_it_is_written_and_as_nothing_else) {
    const std::string archive = pack({.files = new_version, .number = 4});
    const std::size_t length = archive.find('\0', PACKAGE_BLOCK) - PACKAGE_BLOCK;
    const std::string manifest = archive.substr(PACKAGE_BLOCK, length);
    package_t package;
    ASSERT_TRUE(package_parse_manifest(manifest.data(), manifest.size(), &package)) << manifest;
    EXPECT_STREQ(package.rover, "Traveller");
    EXPECT_EQ(package.count, 3u);
    EXPECT_EQ(package.file[0].size, 9001u);
    std::mt19937 chance(20261125);
    for (int i = 0; i < (emulated ? 1000 : 20000); i++) { // whatever stands there: refused, or written again as it is
        std::string text = manifest;
        for (auto n = chance() % 4; n-- > 0;) {
            const std::size_t at = chance() % text.size();
            const auto way = chance() % 3;
            if (way == 0) text[at] = static_cast<char>(chance());
            if (way == 1) text.erase(at, 1 + chance() % 9);
            if (way == 2) text.insert(at, text.substr(chance() % text.size(), chance() % 9));
            if (text.empty()) break;
        }
        char again[PACKAGE_TEXT];
        if (package_parse_manifest(text.data(), text.size(), &package)) {
            ASSERT_EQ(std::string(again, package_print_manifest(&package, again)), text);
        }
    }
    for (const char *name : {"", "..", ".hidden", "a/b", "-rf", "manifest", "manifest.sig", "a b", "tractiond"}) {
        package_t made;
        ASSERT_TRUE(package_parse_manifest(manifest.data(), manifest.size(), &made));
        std::strcpy(made.file[1].name, name);
        char text[PACKAGE_TEXT];
        EXPECT_EQ(package_print_manifest(&made, text), 0u) << name;
    }
}
