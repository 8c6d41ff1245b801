#include <rapidcheck.h>

#include "csv_rows.hpp"

using aabblab::csv_line;
using aabblab::read_csv;

namespace {

using table = std::vector<std::vector<std::string>>;

std::string rejection_of(const std::string& text) {
    return refusal_in<aabb::input_error>([&] { return read_csv(text, "t.csv"); });
}

}  // namespace

TEST_CASE("CSV is read and written as RFC 4180 specifies") {
    CHECK(csv_line(std::vector<std::string>{"a", "", "b c"}) == "a,,b c\n");
    CHECK(csv_line(std::vector<std::string>{"a,b", "\"", "c\nd", "\r"}) == "\"a,b\",\"\"\"\",\"c\nd\",\"\r\"\n");
    CHECK(fields_of("a,b\r\nc,\"d\r\ne\"\r\n") == table{{"a", "b"}, {"c", "d\r\ne"}});
    CHECK(fields_of("\"a\",\"\"\n,\n\n") == table{{"a", ""}, {"", ""}, {""}});
    CHECK(read_csv("\"a\nb\",c\nd\n", "t.csv").records[1].line == 3);
    CHECK(rejection_of("a\nb,c\"d\n") == "t.csv:2: a quote is in a field that does not begin with one");
    CHECK(rejection_of("a,\"b\n\"c\n") == "t.csv:2: expected a comma or the end of the line after a closing quote");
}

TEST_CASE("CSV round-trips, and a truncated record is omitted") {
    REQUIRE(rc::check([] {
        const auto character = rc::gen::element(',', '"', '\n', '\r', 'a', ' ');
        const auto record =
            rc::gen::nonEmpty(rc::gen::container<std::vector<std::string>>(rc::gen::container<std::string>(character)));
        const table written = *rc::gen::container<table>(record);
        std::string text;
        std::vector<std::size_t> ends{0};
        for (const auto& fields : written) ends.push_back((text += csv_line(fields)).size());
        RC_ASSERT(fields_of(text) == written);
        const auto cut = *rc::gen::inRange<std::size_t>(0, text.size() + 1);
        std::size_t complete = 0;
        while (complete + 1 < ends.size() && ends[complete + 1] <= cut) ++complete;
        const auto parsed = read_csv(text.substr(0, cut), "t.csv");
        RC_ASSERT(parsed.records.size() == complete);
        RC_ASSERT(parsed.bytes == ends[complete]);
        if (parsed.bytes < cut)
            RC_ASSERT_THROWS_AS((void)aabblab::whole_records_of(text.substr(0, cut), "t.csv"), aabb::input_error);
        else
            RC_ASSERT(aabblab::whole_records_of(text.substr(0, cut), "t.csv").size() == complete);
    }));
}
