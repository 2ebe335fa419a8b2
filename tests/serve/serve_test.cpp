// The HTTP surface of `traction serve`, by raw sockets: who may ask, for what, and what is never reached. The program under test is the
// built one; its answers are compared with the command line's own.
#include "host_tools/log/log.h"
#include "host_tools/log/ulog.h"
#include "host_tools/serve/child.h"
#include "host_tools/serve/http.h"
#include "host_tools/serve/token.h"
#include "host_tools/serve/workshop.h"

#include <cstdint>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

namespace traction::serve {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using namespace std::chrono_literals;

const std::string token = "0123456789012345678901234567890123456789abc";

std::string content(const fs::path &path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

int connected(int port) {
    const int fd = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    inet_pton(AF_INET, "127.0.0.1", &address.sin_addr);
    if (connect(fd, reinterpret_cast<const sockaddr *>(&address), sizeof address) != 0) ADD_FAILURE() << "no connection";
    const timeval patience{20, 0};
    setsockopt(fd, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    return fd;
}

// Everything that comes until the other side closes, or until `enough` stands in it.
std::string received(int fd, const std::string &enough = "") {
    std::string all;
    std::array<char, 65536> bytes;
    for (ssize_t got; (got = recv(fd, bytes.data(), bytes.size(), 0)) > 0;) {
        all.append(bytes.data(), static_cast<std::size_t>(got));
        if (!enough.empty() && all.find(enough) != std::string::npos) break;
    }
    return all;
}

std::string raw(int port, const std::string &text) {
    const int fd = connected(port);
    send(fd, text.data(), text.size(), MSG_NOSIGNAL);
    std::string all = received(fd);
    close(fd);
    return all;
}

int status_of(const std::string &answer) { return answer.size() < 12 ? 0 : std::atoi(answer.c_str() + 9); }
json body_of(const std::string &answer) { return json::parse(answer.substr(answer.find("\r\n\r\n") + 4), nullptr, false); }

class Served : public testing::Test {
  protected:
    void SetUp() override {
        home_ = fs::temp_directory_path() /
                ("traction_serve_" + std::to_string(getpid()) + "_" + testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::remove_all(home_);
        fs::create_directories(home_ / "drives");
        std::ofstream(home_ / "secret.csv") << "# format: traction-log 1\nt_s,x_m\n0,1\n";
        begin();
    }
    void TearDown() override {
        end();
        fs::remove_all(home_);
    }
    void begin(std::optional<Rover> rover = std::nullopt, const std::string &program = TRACTION_PROGRAM) {
        workshop_ = std::make_unique<Workshop>(folder(), fs::path("."), program, std::move(rover));
        server_ = std::make_unique<Server>(*workshop_, 0, token);
        thread_ = std::thread([this] { server_->listen(); });
        for (int i = 0; i < 100; ++i) { // until it listens
            if (!get("/api/effects").empty()) break;
            std::this_thread::sleep_for(20ms);
        }
    }
    void end() {
        if (!server_) return;
        server_->stop();
        thread_.join();
        server_.reset();
        workshop_.reset();
    }
    fs::path folder() const { return home_ / "drives"; }
    int port() const { return server_->port(); }
    std::string host() const { return "127.0.0.1:" + std::to_string(port()); }

    std::string get(const std::string &target, const std::string &more = "", const std::string &with = token) const {
        return raw(port(), "GET " + target + " HTTP/1.1\r\nHost: " + host() + "\r\n" +
                               (with.empty() ? "" : "X-Traction-Token: " + with + "\r\n") + more + "\r\n");
    }
    std::string post(const std::string &target, const std::string &body, const std::string &more = "",
                     const std::string &type = "application/json") const {
        return raw(port(), "POST " + target + " HTTP/1.1\r\nHost: " + host() + "\r\nX-Traction-Token: " + token + "\r\nContent-Type: " +
                               type + "\r\nContent-Length: " + std::to_string(body.size()) + "\r\n" + more + "\r\n" + body);
    }
    // Starts a run and waits for its end: its entry in the history.
    json run(const json &request) const {
        const std::string answer = post("/api/run", request.dump());
        if (status_of(answer) != 200) return {{"state", "refused"}, {"status", status_of(answer)}, {"message", body_of(answer)["error"]}};
        return ended(body_of(answer)["id"]);
    }
    json ended(int id) const {
        for (int i = 0; i < 6000; ++i) {
            const json state = workshop_->state();
            for (const json &entry : state["history"])
                if (entry["id"] == id && entry["state"] != "running") return entry;
            std::this_thread::sleep_for(50ms);
        }
        return {{"state", "never ended"}};
    }
    json listed() const {
        json names = json::array();
        const json state = workshop_->state();
        for (const json &file : state["files"])
            if (file["name"].get<std::string>().rfind("shipped/", 0) != 0) names.push_back(file["name"]);
        return names;
    }
    json drive(int seconds, bool realtime = false) const {
        return {{"verb", "simulate"}, {"scenario", "shipped/cruise.toml"}, {"seed", 3}, {"seconds", seconds}, {"realtime", realtime}};
    }

    fs::path home_;
    std::unique_ptr<Workshop> workshop_;
    std::unique_ptr<Server> server_;
    std::thread thread_;
};

TEST_F(Served, nothing_is_answered_without_the_token) {
    std::string nearly = token;
    nearly.back() = 'X';
    for (const std::string &wrong : {std::string(), std::string("x"), token.substr(1), token + "0", nearly})
        for (const char *target : {"/", "/events", "/api/effects", "/api/rover", "/api/scene", "/api/result/1", "/nothing"})
            EXPECT_EQ(status_of(get(target, "", wrong)), 403) << target << " with '" << wrong << "'";
    EXPECT_EQ(status_of(get("/?token=" + token, "", "")), 200);
    EXPECT_EQ(status_of(get("/?token=" + token, "", nearly)), 403); // the header counts where both are there
    EXPECT_EQ(status_of(raw(port(), "POST /api/run HTTP/1.1\r\nHost: " + host() +
                                        "\r\nContent-Type: application/json\r\nContent-Length: 2\r\n\r\n{}")),
              403);
}

TEST_F(Served, a_host_that_is_not_this_machine_is_refused) { // DNS rebinding: the name is the attacker's, the address is ours
    const auto as = [&](const std::string &hosts) {
        return status_of(raw(port(), "GET /api/effects HTTP/1.1\r\n" + hosts + "X-Traction-Token: " + token + "\r\n\r\n"));
    };
    const std::string p = std::to_string(port());
    EXPECT_EQ(as("Host: localhost:" + p + "\r\n"), 200);
    for (const std::string &bad :
         {std::string("Host: evil.example:") + p, std::string("Host: evil.example"), std::string("Host: 127.0.0.1"),
          "Host: 127.0.0.1.evil.example:" + p, "Host: 127.0.0.1:" + p + ".evil.example", std::string("Host: ")})
        EXPECT_EQ(as(bad + "\r\n"), 403) << bad;
    EXPECT_EQ(as(""), 403);
    EXPECT_EQ(as("Host: " + host() + "\r\nHost: evil.example\r\n"), 403);
}

TEST_F(Served, another_page_is_refused_even_with_the_token) { // CSRF
    for (const std::string &bad : {std::string("Origin: http://evil.example"), std::string("Origin: null"), "Origin: https://" + host(),
                                   "Origin: http://" + host() + ".evil.example", std::string("Sec-Fetch-Site: cross-site"),
                                   std::string("Sec-Fetch-Site: same-site")})
        EXPECT_EQ(status_of(get("/api/effects", bad + "\r\n")), 403) << bad;
    EXPECT_EQ(status_of(get("/api/effects", "Origin: http://" + host() + "\r\nSec-Fetch-Site: same-origin\r\n")), 200);
    EXPECT_EQ(status_of(post("/api/run", "{}", "", "text/plain")), 415); // what a form of another page could send
    EXPECT_EQ(listed(), json::array());
}

TEST_F(Served, the_page_forbids_what_it_does_not_need) {
    const std::string answer = get("/"), again = get("/");
    const auto nonce_of = [](const std::string &text) { return text.substr(text.find("'nonce-") + 7, 43); };
    EXPECT_NE(answer.find("default-src 'none'"), std::string::npos);
    EXPECT_EQ(answer.find("unsafe"), std::string::npos);
    EXPECT_NE(answer.find("frame-ancestors 'none'"), std::string::npos);
    EXPECT_NE(answer.find("Referrer-Policy: no-referrer"), std::string::npos); // the token stands in the address
    EXPECT_NE(answer.find("Cache-Control: no-store"), std::string::npos);
    EXPECT_EQ(answer.find("__TRACTION_NONCE__"), std::string::npos);
    EXPECT_NE(answer.find("<script type=\"module\" nonce=\"" + nonce_of(answer)), std::string::npos);
    EXPECT_NE(nonce_of(answer), nonce_of(again));
    EXPECT_EQ(answer.find("Access-Control"), std::string::npos);
}

TEST_F(Served,
       no_answer_is_packed_whatever_the_browser_takes) { // brotli would cost seconds of a processor to save a way inside the machine
    for (const char *target : {"/", "/api/scene", "/api/effects"}) {
        const std::string answer = get(target, "Accept-Encoding: gzip, deflate, br\r\n");
        EXPECT_EQ(status_of(answer), 200);
        EXPECT_EQ(answer.find("Content-Encoding"), std::string::npos) << target;
        const std::size_t at = answer.find("Content-Length: ");
        ASSERT_NE(at, std::string::npos) << target;
        EXPECT_EQ(std::strtoul(answer.c_str() + at + 16, nullptr, 10), answer.size() - answer.find("\r\n\r\n") - 4) << target;
    }
}

TEST_F(Served, no_name_leads_out_of_the_folder) {
    std::ofstream(folder() / "own.csv") << "# format: traction-log 1\nt_s,x_m\n0,1\n";
    fs::create_symlink(home_ / "secret.csv", folder() / "link.csv");
    fs::create_directory_symlink(home_, folder() / "up");
    fs::create_directory(folder() / "sub");
    fs::copy(home_ / "secret.csv", folder() / "sub/deep.csv");
    ASSERT_EQ(mkfifo((folder() / "pipe.csv").c_str(), 0600), 0);
    std::ofstream(folder() / "quote\".csv") << "# format: traction-log 1\nt_s,x_m\n0,1\n";
    for (const json &name : {json("../secret.csv"), json("link.csv"), json("up/secret.csv"), json("sub/deep.csv"), json("./own.csv"),
                             json((home_ / "secret.csv").string()), json("own.csv/"), json(std::string("own.csv\0", 8)), json("pipe.csv"),
                             json("quote\".csv"), json("traction_serve/token"), json(".."), json(""), json("--help"), json("/dev/zero"),
                             json("shipped/../../etc/passwd"), json(7), json::array({"own.csv"}), json()}) {
        const json refused = run({{"verb", "check"}, {"log", name}});
        EXPECT_EQ(refused["state"], "refused") << name;
        EXPECT_EQ(refused["status"], 400) << name;
    }
    EXPECT_EQ(listed(), json({"own.csv"}));
    EXPECT_EQ(run({{"verb", "check"}, {"log", "own.csv"}})["state"], "done");
    for (const char *target : {"/api/result/../history", "/api/result/token", "/api/result/-1", "/api/result/0", "/api/result/99",
                               "/api/result/1%2e%2e", "/traction_serve/token", "/../secret.csv", "/%2e%2e/secret.csv", "/own.csv"})
        EXPECT_EQ(status_of(get(target)), 404) << target;
}

// A log's kind is told by its content: the format's line below the names, however long they are, or above them, or a ULog of ours.
TEST_F(Served, logs_of_either_format_are_listed_and_others_are_not) {
    log::Log log;
    log.header["title"] = "wide";
    for (int i = 0; i < 900; ++i) // 16 kB of names
        log.signals.push_back({"arm.joint_" + std::to_string(i) + "_rad", {0, 0.5, 1}, {0, 1, 2}});
    log::write_csv(log, (folder() / "wide.csv").string());
    log::write_ulog(log, (folder() / "wide.ulg").string());
    std::ofstream(folder() / "above.csv") << "# format: traction-log 1\nt_s,x_m\n0,1\n";
    std::ofstream(folder() / "foreign.csv") << "time;x\n0;1\n";
    std::ofstream(folder() / "rover.ulg", std::ios::binary) << "ULog\x01\x12\x35" << std::string(200, '\0');
    EXPECT_EQ(run({{"verb", "check"}, {"log", "wide.ulg"}})["state"], "done");
    EXPECT_EQ(run({{"verb", "check"}, {"log", "rover.ulg"}})["state"], "refused");
    json logs = json::array();
    const json state = workshop_->state();
    for (const json &file : state["files"])
        if (file["kind"] == "log") logs.push_back(file["name"]);
    EXPECT_EQ(logs, json({"above.csv", "wide.csv", "wide.ulg"}));
}

TEST_F(Served, a_request_that_is_wrong_is_told_so_and_changes_nothing) {
    std::ofstream(folder() / "own.csv") << "# format: traction-log 1\nt_s,x_m\n0,1\n";
    const auto error = [&](const std::string &body) {
        const std::string answer = post("/api/run", body);
        EXPECT_EQ(status_of(answer), 400) << body;
        return body_of(answer).value("error", "");
    };
    EXPECT_EQ(error("{"), "the body is no JSON");
    EXPECT_EQ(error("[]"), "the request is no JSON object");
    EXPECT_NE(error(R"({"verb":"rm"})").find("\"rm\" is none"), std::string::npos);
    EXPECT_NE(error(R"({"verb":"check","log":"own.csv","out":"x"})").find("\"out\": is no key of check"), std::string::npos);
    EXPECT_NE(error(R"({"verb":"compare","log":"own.csv"})").find("model: is missing"), std::string::npos);
    const std::string pair = R"("log":"own.csv","model":"shipped/rover_sand.toml")";
    EXPECT_NE(error(R"({"verb":"add",)" + pair + R"(,"effect":"--out=/tmp/x"})").find("none of the catalogue"), std::string::npos);
    EXPECT_NE(error(R"({"verb":"add",)" + pair + R"(,"effect":"slip_sinkage","wheel":4})").find("whole number from -1 to 3"),
              std::string::npos);
    EXPECT_NE(error(R"({"verb":"simulate","scenario":"shipped/cruise.toml","seconds":1e9})").find("seconds"), std::string::npos);
    EXPECT_NE(error(R"({"verb":"simulate","scenario":"shipped/cruise.toml","seed":18446744073709551615})").find("seed"), std::string::npos);
    EXPECT_NE(error(R"({"verb":"simulate","scenario":"shipped/cruise.toml","realtime":"yes"})").find("true or false"), std::string::npos);
    EXPECT_EQ(status_of(post("/api/cancel", R"({"id":1})")), 409);
    EXPECT_EQ(status_of(post("/api/seal", R"({"id":1})")), 400);
    EXPECT_EQ(status_of(post("/api/cancel", R"({"id":"1"})")), 400);
    EXPECT_EQ(status_of(raw(port(), "DELETE / HTTP/1.1\r\nHost: " + host() + "\r\nX-Traction-Token: " + token + "\r\n\r\n")), 405);
    EXPECT_EQ(workshop_->state()["history"], json::array());
}

TEST_F(Served, a_body_that_is_too_large_is_refused_and_the_server_goes_on) {
    EXPECT_EQ(status_of(post("/api/run", std::string(70000, ' '))), 413);
    EXPECT_EQ(status_of(raw(port(), "POST /api/run HTTP/1.1\r\nHost: " + host() + "\r\nX-Traction-Token: " + token +
                                        "\r\nContent-Type: application/json\r\nContent-Length: 99999999999999\r\n\r\nx")),
              413);
    std::string deep(30000, '[');
    EXPECT_EQ(status_of(post("/api/run", deep)), 400);
    EXPECT_EQ(status_of(get("/api/effects")), 200);
    for (const std::string &junk : {std::string("\0\0\0\r\n\r\n", 7), std::string("GET\r\n\r\n"), std::string(20000, 'A') + "\r\n\r\n"})
        raw(port(), junk);
    EXPECT_EQ(status_of(get("/api/effects")), 200);
}

TEST_F(Served, what_a_refused_request_leaves_unread_is_not_the_next_request) { // smuggling
    const std::string inner = "GET /api/effects HTTP/1.1\r\nHost: " + host() + "\r\nX-Traction-Token: " + token + "\r\n\r\n";
    const std::string answer =
        raw(port(), "POST /api/run HTTP/1.1\r\nHost: evil.example\r\nContent-Length: " + std::to_string(inner.size()) + "\r\n\r\n" + inner);
    EXPECT_EQ(status_of(answer), 403);
    EXPECT_EQ(answer.find("HTTP/1.1 200"), std::string::npos);
}

TEST_F(Served, a_new_file_and_a_growing_one_come_by_events) {
    const int fd = connected(port());
    const std::string request = "GET /events?token=" + token + " HTTP/1.1\r\nHost: " + host() + "\r\n\r\n";
    send(fd, request.data(), request.size(), MSG_NOSIGNAL);
    EXPECT_NE(received(fd, "event: state").find("text/event-stream"), std::string::npos);
    std::ofstream(folder() / "fresh.csv") << "# format: traction-log 1\nt_s,x_m\n0,1\n";
    EXPECT_NE(received(fd, "\"name\":\"fresh.csv\"").find("\"growing\":false"), std::string::npos);
    std::ofstream(folder() / "fresh.csv", std::ios::app) << "1,2\n";
    EXPECT_NE(received(fd, "\"growing\":true").find("fresh.csv"), std::string::npos);
    close(fd);
}

TEST_F(Served, a_page_that_comes_back_gets_everything_anew_and_many_at_once_see_the_same) {
    EXPECT_EQ(run(drive(4))["state"], "done");
    std::vector<std::string> seen(12);
    std::vector<std::thread> browsers;
    for (std::string &one : seen)
        browsers.emplace_back([&one, this] {
            const int fd = connected(port());
            const std::string request = "GET /events?token=" + token + " HTTP/1.1\r\nHost: " + host() + "\r\n\r\n";
            send(fd, request.data(), request.size(), MSG_NOSIGNAL);
            one = received(fd, "[3.90,");
            close(fd);
        });
    std::atomic<int> good{0};
    std::vector<std::thread> askers;
    for (int i = 0; i < 8; ++i)
        askers.emplace_back([&] {
            for (int k = 0; k < 10; ++k) good += status_of(get("/api/effects")) == 200;
        });
    for (std::vector<std::thread> *all : {&browsers, &askers})
        for (std::thread &one : *all) one.join();
    EXPECT_EQ(good, 80);
    for (const std::string &one : seen) {
        EXPECT_NE(one.find("\"state\":\"done\""), std::string::npos);
        EXPECT_NE(one.find("\"from\":0,\"rows\":[[0.00,"), std::string::npos);
    }
}

TEST_F(Served, more_pages_than_it_can_serve_are_refused_and_free_their_place_when_they_go) {
    const std::string request = "GET /events?token=" + token + " HTTP/1.1\r\nHost: " + host() + "\r\n\r\n";
    std::vector<int> open;
    for (int i = 0; i < 16; ++i) {
        open.push_back(connected(port()));
        send(open.back(), request.data(), request.size(), MSG_NOSIGNAL);
        received(open.back(), "event: state");
    }
    EXPECT_EQ(status_of(raw(port(), request)), 503);
    EXPECT_EQ(status_of(get("/api/effects")), 200); // the rest still answers
    for (const int fd : open) close(fd);
    for (int i = 0; i < 100; ++i) { // noticed with the next sign of life, 2 s at most
        const int fd = connected(port());
        send(fd, request.data(), request.size(), MSG_NOSIGNAL);
        const bool in = status_of(received(fd, "\r\n\r\n")) == 200;
        close(fd);
        if (in) return;
        std::this_thread::sleep_for(100ms);
    }
    ADD_FAILURE() << "no place became free";
}

TEST_F(Served, the_pages_results_are_the_command_lines) {
    const json driven = run({{"verb", "simulate"}, {"scenario", "shipped/demo_sand.toml"}, {"seconds", 20}, {"effect", "slip_sinkage"}});
    ASSERT_EQ(driven["state"], "done") << driven;
    const std::string log = driven["log"].get<std::string>();
    const std::atomic<int> never{0};
    int count = 0;
    for (const char *verb : {"check", "compare", "diagnose", "add"}) {
        json request = {{"verb", verb}, {"log", log}, {"model", "shipped/rover_sand.toml"}};
        std::vector<std::string> words = {verb};
        if (verb == std::string("add")) request["effect"] = "slip_sinkage", words.emplace_back("slip_sinkage");
        const fs::path result = home_ / (std::to_string(++count) + ".json");
        const std::string model = fs::absolute("models/rover_sand.toml").string();
        for (const std::string &word :
             {(folder() / log).string(), std::string("--model"), verb == std::string("check") ? "./models/rover_sand.toml" : model,
              std::string("--json"), result.string()})
            words.push_back(word);
        if (verb == std::string("add")) words.insert(words.end(), {"--out", (home_ / (log + ".toml")).string()});
        const json entry = run(request);
        ASSERT_EQ(entry["state"], "done") << entry;
        EXPECT_LE(run_child(TRACTION_PROGRAM, words, {}, never).exit_code, 1);
        json page = body_of(get("/api/result/" + entry["id"].dump())), line = json::parse(content(result));
        if (verb == std::string("add")) page["model"].erase("file"), line["model"].erase("file"); // the new file's name
        EXPECT_EQ(page, line) << verb;
    }
}

TEST_F(Served, a_drive_is_looked_at_as_its_page_shows_it_and_a_log_without_a_pose_is_told_so) {
    ASSERT_EQ(run(drive(5))["state"], "done");
    const json looked = run({{"verb", "look"}, {"log", "cruise_3.csv"}});
    ASSERT_EQ(looked["state"], "done") << looked;
    const json shown = body_of(get("/api/result/" + looked["id"].dump()));
    const std::string page = (home_ / "page.html").string();
    std::atomic<int> none{0};
    ASSERT_EQ(run_child(TRACTION_PROGRAM, {"report", (folder() / "cruise_3.csv").string(), "--out", page}, {}, none).exit_code, 0);
    const std::string text = content(page), begin = "<script type=\"application/json\" id=\"result\">";
    const std::size_t from = text.find(begin) + begin.size();
    EXPECT_EQ(json::parse(text.substr(from, text.find("</script>", from) - from)), shown);
    EXPECT_EQ(shown["replay"]["pose_from"], "camera");
    const std::string scene = get("/api/scene");
    EXPECT_NE(text.find(scene.substr(scene.find("\r\n\r\n") + 4)), std::string::npos); // the code is the page's, every byte
    std::ofstream(folder() / "blind.csv") << "t_s,wheel0.current_A\n# format: traction-log 1\n0,1\n1,2\n";
    const json blind = run({{"verb", "look"}, {"log", "blind.csv"}});
    EXPECT_EQ(blind["state"], "failed");
    EXPECT_NE(blind["message"].get<std::string>().find("says nowhere where the rover was"), std::string::npos) << blind;
    const auto rover_of = [&](const std::string &model) {
        const json one = run({{"verb", "look"}, {"log", "cruise_3.csv"}, {"model", model}});
        EXPECT_EQ(one["state"], "done") << one;
        return body_of(get("/api/result/" + one["id"].dump()))["replay"]["rover"];
    };
    EXPECT_EQ(rover_of("shipped/rover_sand.toml"), shown["replay"]["rover"]); // its wheels are the reference's
    const json husky = rover_of("shipped/husky.toml");
    ASSERT_EQ(husky["wheel"].size(), 4U) << husky;
    EXPECT_NEAR(husky["wheel"][0]["radius_m"].get<double>(), 0.165, 0.01) << husky;
    const std::string result = (folder() / "traction_serve/1.json").string(), data = (home_ / "data.json").string();
    EXPECT_EQ(run_child(TRACTION_PROGRAM, {"report", result, "--out", data}, {}, none).exit_code, 2); // of a log alone
    EXPECT_FALSE(fs::exists(data));
}

TEST_F(Served, a_model_of_ones_own_is_never_written_over) {
    ASSERT_EQ(run({{"verb", "simulate"}, {"scenario", "shipped/demo_sand.toml"}, {"seconds", 10}})["state"], "done");
    fs::copy("models/rover_sand.toml", folder() / "mine.toml");
    std::ofstream(folder() / "mine_grade.toml") << "my notes\n";
    const std::string before = content(folder() / "mine.toml");
    const json add = {{"verb", "add"}, {"log", "demo_sand.csv"}, {"model", "mine.toml"}, {"effect", "grade"}};
    EXPECT_EQ(run(add)["made"], "mine_grade_2.toml");
    EXPECT_EQ(run(add)["made"], "mine_grade_3.toml");
    EXPECT_EQ(content(folder() / "mine.toml"), before);
    EXPECT_EQ(content(folder() / "mine_grade.toml"), "my notes\n");
    const json dropped = run({{"verb", "drop"}, {"log", "demo_sand.csv"}, {"model", "mine_grade_2.toml"}, {"effect", "grade"}});
    EXPECT_EQ(dropped["made"], "mine_grade_2_without_grade.toml");
    EXPECT_TRUE(dropped["after"].is_number()); // compared at once
    EXPECT_EQ(run({{"verb", "simulate"}, {"scenario", "shipped/demo_sand.toml"}, {"seconds", 1}})["log"], "demo_sand_2.csv");
}

TEST_F(Served, a_drive_shows_itself_while_it_runs_and_what_is_stopped_is_kept_whole) {
    const int id = body_of(post("/api/run", drive(30, true).dump()))["id"];
    EXPECT_EQ(status_of(post("/api/run", drive(1).dump())), 409); // one drive at a time
    Workshop::Seen seen;
    std::string rows;
    while (rows.find("[1.00,") == std::string::npos) rows += workshop_->events(seen, 5000ms);
    EXPECT_EQ(workshop_->state()["history"].back()["state"], "running");
    EXPECT_EQ(status_of(post("/api/cancel", json{{"id", id}}.dump())), 200);
    const json entry = ended(id);
    EXPECT_EQ(entry["state"], "cancelled");
    ASSERT_TRUE(entry.contains("log"));
    EXPECT_NE(content(folder() / entry["log"].get<std::string>()).find("# ended: interrupted"), std::string::npos);
}

TEST_F(Served, a_diagnosis_is_cancelled_at_once_and_leaves_nothing) {
    ASSERT_EQ(run({{"verb", "simulate"}, {"scenario", "shipped/identification.toml"}, {"effect", "slip_sinkage"}})["state"], "done");
    const json request = {{"verb", "diagnose"}, {"log", "identification.csv"}, {"model", "shipped/rover_sand.toml"}};
    const int id = body_of(post("/api/run", request.dump()))["id"];
    Workshop::Seen seen;
    std::string work;
    while (work.find("diagnose: ") == std::string::npos) work += workshop_->events(seen, 5000ms); // the verb's own progress
    const auto asked = std::chrono::steady_clock::now();
    EXPECT_EQ(status_of(post("/api/cancel", json{{"id", id}}.dump())), 200);
    EXPECT_EQ(ended(id)["state"], "cancelled");
    EXPECT_LT(std::chrono::steady_clock::now() - asked, 7s); // SIGKILL follows after 5 s
    EXPECT_EQ(status_of(get("/api/result/" + std::to_string(id))), 404);
    EXPECT_FALSE(fs::exists(folder() / ("traction_serve/" + std::to_string(id) + ".json")));
}

TEST_F(Served, what_is_hidden_is_not_told_before_the_seal_is_opened) {
    const json driven = run({{"verb", "simulate"}, {"scenario", "shipped/demo_sand.toml"}, {"seconds", 5}, {"hidden", true}});
    ASSERT_EQ(driven["state"], "done") << driven;
    const int id = driven["id"];
    const std::string file = content(folder() / ("traction_serve/" + std::to_string(id) + ".seal.json"));
    const std::string hidden = json::parse(file)["effects"][0]["name"];
    Workshop::Seen seen;
    EXPECT_EQ(workshop_->events(seen, 1000ms).find(hidden), std::string::npos);
    EXPECT_EQ(get("/api/result/" + std::to_string(id)).find(hidden), std::string::npos);
    EXPECT_EQ(status_of(get("/api/result/" + std::to_string(id) + ".seal")), 404);
    EXPECT_EQ(status_of(post("/api/seal", json{{"id", id}}.dump())), 200);
    EXPECT_NE(workshop_->events(seen, 1000ms).find(hidden), std::string::npos);
}

TEST_F(Served, the_games_answer_comes_with_its_seal_and_not_before) {
    ASSERT_EQ(run({{"verb", "game_new"}, {"hard", true}})["state"], "done"); // hard: no list of what it may be in the words
    const std::string hidden = json::parse(content(folder() / "game/sealed.json"))["effects"][0]["name"];
    const auto told = [&] {
        std::string all;
        Workshop::Seen seen;
        all += workshop_->events(seen, 1000ms);
        const json state = workshop_->state();
        for (const json &entry : state["history"]) all += get("/api/result/" + entry["id"].dump());
        return all.find(hidden) != std::string::npos;
    };
    EXPECT_FALSE(told());
    EXPECT_FALSE(workshop_->state()["game"].contains("seed")); // with which anybody could draw it again
    const json opened = run({{"verb", "game_open"}});
    EXPECT_EQ(opened["state"], "done") << opened;
    EXPECT_TRUE(told());
}

TEST_F(Served, the_history_outlives_the_server_and_a_broken_one_is_put_aside) {
    EXPECT_EQ(run(drive(1))["state"], "done");
    end();
    begin();
    EXPECT_EQ(workshop_->state()["history"][0]["log"], "cruise_3.csv");
    end();
    std::ofstream(folder() / "traction_serve/history.json") << "{ broken";
    begin();
    EXPECT_EQ(workshop_->state()["history"], json::array());
    EXPECT_NE(workshop_->state()["trouble"].get<std::string>().find("no history any more"), std::string::npos);
    int aside = 0;
    for (const auto &entry : fs::directory_iterator(folder() / "traction_serve")) aside += content(entry.path()) == "{ broken";
    EXPECT_EQ(aside, 1);
}

TEST_F(Served, a_second_server_of_the_folder_and_a_port_in_use_are_refused) {
    std::atomic<int> stop{0};
    std::jthread patience([&](const std::stop_token &over) { // were it not refused, it would serve for ever
        for (int i = 0; i < 1200 && !over.stop_requested(); ++i) std::this_thread::sleep_for(50ms);
        if (!over.stop_requested()) stop = SIGTERM;
    });
    const Finished second = run_child(TRACTION_PROGRAM, {"serve", folder().string(), "--port", "0"}, {}, stop);
    EXPECT_EQ(second.exit_code, 4);
    EXPECT_NE(second.trouble.find("history.json"), std::string::npos) << second.trouble;
    fs::create_directory(home_ / "other");
    Workshop other(home_ / "other", ".", TRACTION_PROGRAM);
    try {
        Server on_our_port(other, port(), token);
        ADD_FAILURE() << "two servers on one port";
    } catch (const PortError &error) {
        EXPECT_NE(std::string(error.what()).find("Address already in use"), std::string::npos) << error.what();
    }
    EXPECT_THROW(Workshop(home_ / "nowhere", ".", TRACTION_PROGRAM), log::FileError);
    EXPECT_THROW(Workshop(home_ / "secret.csv", ".", TRACTION_PROGRAM), log::FileError);
}

TEST_F(Served, what_runs_ends_with_the_server) {
    post("/api/run", drive(60, true).dump());
    std::this_thread::sleep_for(500ms);
    const auto asked = std::chrono::steady_clock::now();
    end();
    EXPECT_LT(std::chrono::steady_clock::now() - asked, 7s);
    EXPECT_NE(content(folder() / "cruise_3.csv").find("# ended: interrupted"), std::string::npos);
    begin();
    EXPECT_NE(workshop_->state()["history"][0]["state"], "running");
}

TEST_F(Served, a_program_that_fails_is_told_with_its_own_words) {
    std::ofstream(folder() / "foreign.csv") << "a,b\n1,2\n";
    const json entry = run({{"verb", "compare"}, {"log", "foreign.csv"}, {"model", "shipped/rover_sand.toml"}});
    EXPECT_EQ(entry["state"], "failed");
    EXPECT_NE(entry["message"].get<std::string>().find("foreign.csv"), std::string::npos) << entry;
}

TEST_F(Served, no_request_reaches_a_rover_that_was_not_named_or_moves_one_that_was) {
    for (const json &request : {json{{"verb", "watch"}}, json{{"verb", "rover_logs"}}, json{{"verb", "rover_fetch"}, {"number", 1}}})
        EXPECT_NE(run(request)["message"].get<std::string>().find("--host"), std::string::npos) << request;
    end();
    begin(Rover{.host = "127.0.0.1:9", .key = "", .system = 1});
    ASSERT_EQ(status_of(post("/api/cancel", R"({"id": 1})")), 200); // it watches from its beginning on
    ended(1);
    for (const json &request :
         {json{{"verb", "watch"}, {"host", "10.0.0.5"}}, json{{"verb", "watch"}, {"key", "k"}}, json{{"verb", "drive"}},
          json{{"verb", "watch"}, {"speed", 1}}, json{{"verb", "rover_fetch"}}, json{{"verb", "rover_stop"}},
          json{{"verb", "rover_fetch"}, {"number", -1}}, json{{"verb", "rover_fetch"}, {"number", "1; ls"}}})
        EXPECT_EQ(run(request)["status"], 400) << request;
}

TEST_F(Served, of_a_long_watch_the_latest_rows_are_kept_and_sent) {
    end();
    const fs::path teller = home_ / "teller"; // 80,000 rows as `drive --live -` tells them
    std::ofstream(teller) << "#!/bin/sh\n[ \"$1\" = drive ] && seq 1 80000 | sed 's/$/,0.5,0.1/'\n";
    fs::permissions(teller, fs::perms::owner_all);
    begin(Rover{.host = "127.0.0.1", .key = "", .system = 1}, teller.string());
    EXPECT_EQ(ended(1)["state"], "done");
    Workshop::Seen seen;
    std::string all = workshop_->events(seen, 1000ms);
    const json rows = json::parse(all.substr(all.find("{", all.find("event: telemetry"))).substr(0, all.rfind("\n\n")))["rows"];
    EXPECT_EQ(rows.back()[0], 80000);
    EXPECT_EQ(rows.front()[0].get<int>(), 80001 - static_cast<int>(rows.size())); // none is missing between
    EXPECT_GE(rows.size(), 18000u);                                               // half an hour at ten a second
    EXPECT_LE(rows.size(), 36000u);
    seen.telemetry.part = 0; // a page that saw only the rows that were let go meanwhile
    seen.telemetry.count = 10;
    EXPECT_NE(workshop_->events(seen, 1000ms).find("\"from\":0,"), std::string::npos);
}

#ifdef TRACTIOND_PROGRAM

// A simulated rover that stands, on a free port of its own: it can go and come back.
class Watched : public Served {
  protected:
    void SetUp() override {
        Served::SetUp();
        end();
        std::atomic<int> none{0};
        ASSERT_EQ(run_child(TRACTION_PROGRAM, {"drive", "--new-key", key()}, {}, none).exit_code, 0);
        std::ofstream(home_ / "cruise.toml") << "title = \"drives\"\nduration_s = 300.0\nseed = 7\n[ground]\nsoil = \"concrete\"\n"
                                                "[[drive]]\nfor_s = 300.0\nmode = \"platform_speed\"\nspeed_m_s = 0.3\n";
        const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
        sockaddr_in address{};
        address.sin_family = AF_INET;
        inet_pton(AF_INET, "127.0.0.1", &address.sin_addr);
        socklen_t size = sizeof address;
        ASSERT_EQ(bind(fd, reinterpret_cast<sockaddr *>(&address), size), 0);
        getsockname(fd, reinterpret_cast<sockaddr *>(&address), &size);
        at_ = "127.0.0.1:" + std::to_string(ntohs(address.sin_port));
        close(fd);
    }
    void TearDown() override {
        rover_goes();
        Served::TearDown();
    }
    std::string key() const { return (home_ / "key").string(); }
    void rover_comes() {
        signal_ = 0;
        rover_ = std::thread([this] {
            run_child(TRACTIOND_PROGRAM,
                      {"--hal", "sim", (home_ / "cruise.toml").string(), "--link", at_, "--link-key", key(), "--log",
                       (home_ / "onboard").string()},
                      {}, signal_);
        });
    }
    void rover_goes() {
        signal_ = SIGTERM;
        if (rover_.joinable()) rover_.join();
    }
    // The first row from now on that is as asked; null after 30 s.
    json row(const std::function<bool(const json &)> &good) {
        for (const auto until = std::chrono::steady_clock::now() + 30s; std::chrono::steady_clock::now() < until;) {
            std::stringstream lines(workshop_->events(seen_, 1000ms));
            for (std::string line, name; std::getline(lines, line);) {
                if (line.rfind("event: ", 0) == 0) name = line.substr(7);
                if (name != "telemetry" || line.rfind("data: ", 0) != 0) continue;
                const json news = json::parse(line.substr(6));
                for (const json &one : news["rows"])
                    if (one.size() == 17 && good(one)) return one;
            }
        }
        return nullptr;
    }
    static bool heard(const json &row) { return row[15] == 0; }
    static bool silent(const json &row) { return row[15] == 2; }
    std::string at_;
    Workshop::Seen seen_;
    std::thread rover_;
    std::atomic<int> signal_{0};
};

TEST_F(Watched, telemetry_grows_survives_silence_and_a_restart_and_is_kept) {
    begin(Rover{.host = at_, .key = key(), .system = 1});
    EXPECT_FALSE(row([](const json &r) { return r[15] == 1; }).is_null()); // nobody there yet
    rover_comes();
    // 0.3 m/s on concrete; a tenth: the platform's speed loop, as in tests/link/supervision.sh
    const json first = row([](const json &r) { return heard(r) && r[1].is_number() && std::abs(r[1].get<double>() - 0.3) < 0.03; });
    ASSERT_FALSE(first.is_null());
    EXPECT_EQ(first[11], 3);   // platform speed
    EXPECT_EQ(first[12], 0);   // no fault
    EXPECT_GT(first[10], 5.0); // two lithium cells, 7.2 V
    EXPECT_LT(first[10], 9.0);
    for (std::size_t i = 6; i < 10; ++i) EXPECT_GT(first[i], 0.0) << first; // every motor draws current
    EXPECT_LT(first[16], 1.5);
    rover_goes();
    const json gone = row(silent);
    ASSERT_FALSE(gone.is_null());
    EXPECT_TRUE(gone[1].is_null());
    const json later = row([&](const json &r) { return silent(r) && r[16].get<double>() > gone[16].get<double>() + 1; });
    ASSERT_FALSE(later.is_null()); // its age grows
    EXPECT_NEAR(later[0].get<double>() - gone[0].get<double>(), later[16].get<double>() - gone[16].get<double>(), 0.01);
    rover_comes(); // its clock begins anew
    const json back = row(heard);
    ASSERT_FALSE(back.is_null());
    EXPECT_GT(back[0], later[0]);
    const json more = row([&](const json &r) { return heard(r) && r[0].get<double>() > back[0].get<double>() + 1; });
    ASSERT_FALSE(more.is_null());
    // who watches was never taken for one who commands
    std::atomic<int> none{0};
    const std::string told = (home_ / "told.json").string();
    ASSERT_EQ(run_child(TRACTION_PROGRAM, {"drive", "--host", at_, "--key", key(), "--for", "1.5", "--json", told}, {}, none).exit_code, 0);
    const json link = json::parse(content(told))["link"]; // outlives the loop
    for (const auto &[name, count] : link.items()) EXPECT_EQ(count, 0) << name;

    EXPECT_EQ(status_of(post("/api/cancel", R"({"id": 1})")), 200);
    const json entry = ended(1);
    EXPECT_EQ(entry["state"], "done") << entry;
    ASSERT_EQ(entry["log"], "telemetry.csv") << entry;
    const log::Log log = log::read_csv((folder() / "telemetry.csv").string()); // throws where times do not rise
    const log::Signal *speed = log.find("estimate.speed_m_s");
    ASSERT_NE(speed, nullptr);
    double gap_s = 0;
    for (std::size_t i = 1; i < speed->t_s.size(); ++i) gap_s = std::max(gap_s, speed->t_s[i] - speed->t_s[i - 1]);
    EXPECT_GT(gap_s, 2.5); // silent for 1.5 s when it was first told, and a second more
    for (const char *name : {"wheel0.slip", "wheel3.current_A", "battery.voltage_V", "control.mode", "control.faults"})
        EXPECT_NE(log.find(name), nullptr) << name;
    EXPECT_EQ(log.header.at("machine"), "rover at " + at_);
}

TEST_F(Watched, the_rovers_own_logs_come_into_the_folder_while_it_is_watched) {
    rover_comes();
    begin(Rover{.host = at_, .key = key(), .system = 1});
    ASSERT_FALSE(row([](const json &r) { return heard(r) && r[0] > 3; }).is_null());
    const json listed_logs = run({{"verb", "rover_logs"}});
    ASSERT_EQ(listed_logs["state"], "done") << listed_logs;
    ASSERT_FALSE(listed_logs["logs"].empty());
    const json fetched = run({{"verb", "rover_fetch"}, {"number", listed_logs["logs"][0]["id"]}});
    ASSERT_EQ(fetched["state"], "done") << fetched;
    EXPECT_EQ(fetched["log"], "rover_log_1.csv");
    EXPECT_TRUE(fs::exists(folder() / "rover_log_1.ulg"));
    const log::Log log = log::read_csv((folder() / "rover_log_1.csv").string());
    EXPECT_NE(log.find("wheel0.encoder_count"), nullptr); // what telemetry does not carry
    EXPECT_EQ(run({{"verb", "check"}, {"log", "rover_log_1.csv"}})["state"], "done");
    const json none = run({{"verb", "rover_fetch"}, {"number", 777}});
    EXPECT_EQ(none["state"], "failed");
    EXPECT_NE(none["message"].get<std::string>().find("is no log of the rover"), std::string::npos) << none;
    EXPECT_FALSE(none.contains("log"));
    EXPECT_EQ(workshop_->state()["history"][0]["state"], "running"); // it was watched all the while
    end();                                                           // and what was received is kept when the server ends
    EXPECT_TRUE(fs::exists(folder() / "telemetry.csv"));
}

TEST_F(Watched, what_another_key_signed_is_not_believed) {
    rover_comes();
    std::atomic<int> none{0};
    const std::string other = (home_ / "other_key").string();
    ASSERT_EQ(run_child(TRACTION_PROGRAM, {"drive", "--new-key", other}, {}, none).exit_code, 0);
    begin(Rover{.host = at_, .key = other, .system = 1});
    EXPECT_FALSE(row([](const json &r) { return r[15] == 3 && r[1].is_null(); }).is_null());
    EXPECT_EQ(status_of(post("/api/cancel", R"({"id": 1})")), 200);
    EXPECT_FALSE(ended(1).contains("log"));
    EXPECT_FALSE(fs::exists(folder() / "telemetry.csv"));
}

#endif

TEST(Token, is_kept_only_where_it_is_ours_alone) {
    const fs::path path = fs::temp_directory_path() / ("traction_token_" + std::to_string(getpid()));
    fs::remove(path);
    const std::string first = keep_token(path.string());
    EXPECT_EQ(first.size(), 43u);
    struct stat about {};
    ASSERT_EQ(stat(path.c_str(), &about), 0);
    EXPECT_EQ(about.st_mode & 0777u, 0600u);
    EXPECT_EQ(keep_token(path.string()), first);
    fs::permissions(path, fs::perms::owner_read | fs::perms::group_read); // others may have read it
    const std::string second = keep_token(path.string());
    EXPECT_NE(second, first);
    std::ofstream(path) << "short";
    EXPECT_EQ(keep_token(path.string()).size(), 43u);
    EXPECT_TRUE(same_token(first, first));
    EXPECT_FALSE(same_token(first, second));
    EXPECT_FALSE(same_token("", "")); // no secret lets nobody in
    fs::remove(path);
}

} // namespace
} // namespace traction::serve
