// The door between hypcheck and predicate.cpp: questions on standard input, answers on standard output.
//
//     @BUILD@
//
// docs/protocol.md of hypcheck says what is spoken. Only the build line changes when the predicate does.
#include "predicate.hpp"

#include <charconv>
#include <chrono>
#include <clocale>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <numeric>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>
#ifdef _WIN32
#include <fcntl.h>
#include <io.h>
#endif

// A predicate has the function that its description asks for; the other may be missing.
#ifdef __ELF__
@position@
#pragma weak hypcheck_classify
#pragma weak hypcheck_classify_tilted
@passage@
#pragma weak hypcheck_passage
#pragma weak hypcheck_passage_tilted
@end@
#endif

namespace {

constexpr std::size_t most = 65536;

@position@
// Whether the predicate claims "tilt":true, and the numbers of a row then.
const bool tilt = std::strstr(hypcheck_describe(), R"("tilt":true)") != nullptr;
const std::size_t columns = tilt ? 10 : 7;
const char *const no_row = tilt ? "a row is not ten decimals" : "a row is not seven decimals";
const std::string text_form = tilt ? "tilted-text" : "text", binary_form = tilt ? "tilted-binary" : "binary";
@passage@
// Whether the predicate claims "tilt":true and "times":true, and the numbers of a row.
const bool tilt = std::strstr(hypcheck_describe(), R"("tilt":true)") != nullptr;
const bool times = std::strstr(hypcheck_describe(), R"("times":true)") != nullptr;
const std::size_t columns = tilt ? 13 : 10;
const char *const no_row = tilt ? "a row is not thirteen decimals" : "a row is not ten decimals";
const std::string text_form = "passage-text", binary_form = "passage-binary";
@end@

using Rows = std::vector<double>;
using Words = std::vector<std::string>;

Words split(const std::string &line) {
    std::istringstream stream(line);
    Words words;
    for (std::string word; stream >> word;) words.push_back(word);
    return words;
}

// A whole number in digits alone, from least to greatest.
std::uint64_t parse_count(const std::string &word, std::uint64_t least, std::uint64_t greatest) {
    std::uint64_t count = 0;
    const char *end = word.data() + word.size();
    const auto [stop, error] = std::from_chars(word.data(), end, count);
    if (error != std::errc() || stop != end || count < least || count > greatest)
        throw std::invalid_argument("the question is not understood");
    return count;
}

// As many decimals as a row has and nothing else. strtod rounds correctly, and reads a point in the locale that main sets.
void parse_row(const std::string &line, double *row) {
    const char *rest = line.c_str();
    for (std::size_t column = 0; column < columns; column++) {
        char *end;
        row[column] = std::strtod(rest, &end);
        if (end == rest) throw std::invalid_argument(no_row);
        rest = end;
    }
    if (rest[std::strspn(rest, " \t\r")] != '\0') throw std::invalid_argument(no_row);
}

// Float64 from eight bytes, the least significant first, whatever the order of this machine. Written out like this,
// compilers make one load of it; of a loop at -O2 they do not, and it would take longer than most predicates.
double little_endian(const char *byte) {
    const auto at = [byte](int i) { return std::uint64_t(static_cast<unsigned char>(byte[i])) << (8 * i); };
    const std::uint64_t bits = at(0) | at(1) | at(2) | at(3) | at(4) | at(5) | at(6) | at(7);
    double value;
    std::memcpy(&value, &bits, sizeof value);
    return value;
}

Rows read_text(std::size_t n) {
    Words lines(n);
    for (auto &line : lines) std::getline(std::cin, line); // all of them first, so that the next question is found
    Rows rows(columns * n);
    for (std::size_t i = 0; i < n; i++) parse_row(lines[i], &rows[columns * i]);
    return rows;
}

Rows read_binary(std::size_t n) {
    std::vector<char> bytes(8 * columns * n);
    if (!std::cin.read(bytes.data(), static_cast<std::streamsize>(bytes.size())))
        throw std::invalid_argument("the input ended within the rows");
    Rows rows(columns * n);
    for (std::size_t i = 0; i < rows.size(); i++) rows[i] = little_endian(&bytes[8 * i]);
    return rows;
}

@position@
void ask(std::size_t n, const Rows &rows, std::vector<std::int8_t> &positions) {
    (tilt ? hypcheck_classify_tilted : hypcheck_classify)(n, rows.data(), positions.data());
@passage@
struct Answers {
    std::vector<std::int8_t> hits;
    std::vector<double> first;
    explicit Answers(std::size_t n) : hits(n), first(times ? n : 0) {}
};

void ask(std::size_t n, const Rows &rows, Answers &answers) {
    double *first = times ? answers.first.data() : nullptr;
    (tilt ? hypcheck_passage_tilted : hypcheck_passage)(n, rows.data(), answers.hits.data(), first);
}

void write_little_endian(double value) {
    std::uint64_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    for (int i = 0; i < 8; i++) std::cout.put(static_cast<char>(bits >> (8 * i) & 255));
}

void write_lines(const Answers &answers) {
    std::cout.precision(17);
    for (std::size_t i = 0; i < answers.hits.size(); i++) {
        std::cout << int(answers.hits[i]);
        if (times && answers.hits[i] == 1) std::cout << ' ' << answers.first[i];
        std::cout << '\n';
    }
@end@
}

void classify(const Words &words) {
    const std::size_t n = parse_count(words[2], 0, most);
    const bool text = words[3] == text_form;
    const Rows rows = text ? read_text(n) : read_binary(n);
@position@
    std::vector<std::int8_t> positions(n);
    ask(n, rows, positions);
    std::cout << words[1] << ' ' << n << '\n';
    if (text)
        for (const int position : positions) std::cout << position << '\n';
    else
        std::cout.write(reinterpret_cast<const char *>(positions.data()), static_cast<std::streamsize>(n));
@passage@
    Answers answers(n);
    ask(n, rows, answers);
    std::cout << words[1] << ' ' << n << '\n';
    if (text) return write_lines(answers);
    std::cout.write(reinterpret_cast<const char *>(answers.hits.data()), static_cast<std::streamsize>(n));
    for (const double time : answers.first) write_little_endian(time);
@end@
}

void time(const Words &words) {
    using Clock = std::chrono::steady_clock;
    const std::size_t n = parse_count(words[2], 0, most);
    const std::size_t repeat = parse_count(words[3], 1, 999999999);
    const Rows rows = read_binary(n);
@position@
    std::vector<std::int8_t> positions(n);
    const auto start = Clock::now();
    for (std::size_t i = 0; i < repeat; i++) ask(n, rows, positions);
    const auto took = std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - start);
    const long checksum = std::accumulate(positions.begin(), positions.end(), 0L);
@passage@
    Answers answers(n);
    const auto start = Clock::now();
    for (std::size_t i = 0; i < repeat; i++) ask(n, rows, answers);
    const auto took = std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - start);
    const long checksum = std::accumulate(answers.hits.begin(), answers.hits.end(), 0L);
@end@
    std::cout << words[1] << ' ' << took.count() << ' ' << checksum << '\n';
}

void answer(const Words &words) {
    if (words.size() > 2) parse_count(words[1], 0, UINT64_MAX);
    if (words.size() == 4 && words[0] == "classify" && (words[3] == text_form || words[3] == binary_form))
        classify(words);
    else if (words.size() == 5 && words[0] == "time" && words[4] == binary_form)
        time(words);
    else
        throw std::invalid_argument("the question is not understood");
}

} // namespace

int main() {
@position@
    if (!(tilt ? hypcheck_classify_tilted : hypcheck_classify)) {
@passage@
    if (!(tilt ? hypcheck_passage_tilted : hypcheck_passage)) {
@end@
        std::cerr << "the predicate lacks the function that its description asks for, see predicate.hpp\n";
        return 1;
    }
    std::ios::sync_with_stdio(false);
    std::setlocale(LC_NUMERIC, "C");
#ifdef _WIN32
    _setmode(_fileno(stdin), _O_BINARY);
    _setmode(_fileno(stdout), _O_BINARY);
#endif
    std::cout << hypcheck_describe() << std::endl;
    for (std::string line; std::getline(std::cin, line);) {
        try {
            answer(split(line));
        } catch (const std::invalid_argument &trouble) {
            std::cout << "error " << trouble.what() << '\n';
        }
        std::cout.flush();
    }
}
