#pragma once

#include "program.hpp"

import aabblab.results;

/// The fields of each record of a CSV text.
[[nodiscard]] inline std::vector<std::vector<std::string>> fields_of(const std::string& text) {
    std::vector<std::vector<std::string>> rows;
    for (const aabblab::csv_record& record : aabblab::read_csv(text, "t.csv").records) rows.push_back(record.fields);
    return rows;
}

/// The rows below the header of a CSV text of whole numbers.
[[nodiscard]] inline std::vector<std::vector<std::uint32_t>> numbers_of(const std::string& text) {
    std::vector<std::vector<std::uint32_t>> rows;
    for (const std::vector<std::string>& fields : fields_of(text.substr(text.find('\n') + 1))) {
        std::vector<std::uint32_t>& row = rows.emplace_back();
        for (const std::string& number : fields) row.push_back(static_cast<std::uint32_t>(std::stoul(number)));
    }
    return rows;
}

/// The rows of a CSV file below its header, each cell by the name of its column.
[[nodiscard]] inline std::vector<std::map<std::string, std::string>> csv_rows(const std::filesystem::path& file) {
    const auto records = aabblab::read_csv(bytes_of_file(file), file.string()).records;
    std::vector<std::map<std::string, std::string>> rows;
    for (const aabblab::csv_record& record : std::span(records).subspan(1)) {
        REQUIRE(record.fields.size() == records[0].fields.size());
        auto& row = rows.emplace_back();
        for (std::size_t c = 0; c < record.fields.size(); ++c) row[records[0].fields[c]] = record.fields[c];
    }
    return rows;
}
