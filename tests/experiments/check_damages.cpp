#include "checked_lists.hpp"

import aabblab.files;

// Lists that are damaged in the usual ways, and what `check` says of each: the same as in the stored table.

namespace {

/// Text with each run of blanks and line breaks as one blank.
std::string in_one_line(const std::string& text) {
    std::string line;
    for (const char c : text) {
        const char blank = c == '\n' ? ' ' : c;
        if (blank != ' ' || line.empty() || line.back() != ' ') line += blank;
    }
    return line;
}

/// What the stored table says of a damage: its line, and those below that are indented.
std::string stored_text(const std::string& damage) {
    const std::string table = bytes_of_file(AABBLAB_CHECKING "/libraries/lists.txt");
    const std::size_t begin = table.find("\n" + damage + "  ");
    INFO(damage);
    REQUIRE(begin != std::string::npos);
    std::size_t end = table.find('\n', begin + 1);
    while (end + 1 < table.size() && table[end + 1] == ' ') end = table.find('\n', end + 1);
    return in_one_line(table.substr(begin, end - begin));
}

/// What `check` prints on a list.
std::string said_of(const std::string& scene, const std::string& list) {
    const program_result result = run_program({"check", scene, list});
    REQUIRE((result.status == 0 || result.status == 1));
    return in_one_line(result.out);
}

}  // namespace

TEST_CASE_METHOD(in_folder, "check says what is wrong with lists that are damaged, as the stored table has it") {
    const checked_scene scene = scene_in(folder);
    std::vector<std::vector<aabb::box>> frames;
    const auto boxes = aabblab::open_boxes(scene.recording);
    for (std::vector<aabb::box> frame; boxes->next(frame);) frames.push_back(frame);
    const std::int64_t last = 59;
    std::map<std::int64_t, int> pairs_of;  // by object
    for (const auto& [frame, a, b] : scene.pairs) ++pairs_of[a], ++pairs_of[b];
    const std::int64_t lost = std::ranges::max_element(pairs_of, {}, [](const auto& n) { return n.second; })->first;
    const auto keep = [](rows& list, const auto& is_kept) {
        std::erase_if(list, [&](const auto& row) { return !is_kept(row); });
    };
    struct damage {
        std::string name, said;
        std::function<void(rows&)> make;
    };
    const damage damages[] = {
        {"none", "The list is right.", [](rows&) {}},
        {"ids in the other order", "The list is right.",
         [](rows& list) {
             for (auto& [frame, a, b] : list) std::swap(a, b);
         }},
        {"ids from 1", "Ids are off by one: with 1 taken from each, the list is right.",
         [](rows& list) {
             for (auto& [frame, a, b] : list) ++a, ++b;
         }},
        {"ids mirrored", "Ids are mirrored: with ",
         [](rows& list) {
             for (auto& [frame, a, b] : list) a = last - a, b = last - b;
         }},
        {"two ids exchanged", "are exchanged: with each in place of the other, the list is right.",
         [&](rows& list) {
             const std::int64_t other = lost == last ? 0 : last;
             for (auto& [frame, a, b] : list)
                 for (std::int64_t* id : {&a, &b})
                     if (*id == lost || *id == other) *id = lost + other - *id;
         }},
        {"every pair twice", "Every pair is listed twice.",
         [](rows& list) {
             const rows once = list;
             list.insert(list.end(), once.begin(), once.end());
         }},
        {"self pairs added", "self pairs",
         [](rows& list) {
             for (std::int64_t frame = 0; frame < 6; ++frame)
                 for (std::int64_t i = 0; i <= last; ++i) list.push_back({frame, i, i});
         }},
        {"list of frame 5 kept", "The list is not renewed: from frame ",
         [&](rows& list) {
             keep(list, [](const auto& row) { return row[0] <= 2; });
             const rows until_2 = list;
             for (std::int64_t frame = 3; frame < 6; ++frame)
                 for (const auto& [of, a, b] : until_2)
                     if (of == 2) list.push_back({frame, a, b});
         }},
        {"frames from 1", "Frames are off by one: with 1 taken from each, the list is right.",
         [](rows& list) {
             for (auto& row : list) ++row[0];
         }},
        {"one frame late", "The list is late: every wrong frame has the pairs of the frame before.",
         [&](rows& list) {
             const rows given = list;
             keep(list, [](const auto& row) { return row[0] == 0; });
             for (const auto& [frame, a, b] : given)
                 if (frame < 5) list.push_back({frame + 1, a, b});
         }},
        {"frame 5 missing", "The list has no rows of frame ",
         [&](rows& list) { keep(list, [](const auto& row) { return row[0] != 3; }); }},
        {"one object lost", "is in every wrong pair.",
         [&](rows& list) { keep(list, [&](const auto& row) { return row[1] != lost && row[2] != lost; }); }},
        {"z not tested", "z may not be tested",
         [&](rows& list) {
             list.clear();
             for (std::size_t frame = 0; frame < frames.size(); ++frame)
                 for (std::size_t a = 0; a < frames[frame].size(); ++a)
                     for (std::size_t b = a + 1; b < frames[frame].size(); ++b) {
                         const aabb::box &p = frames[frame][a], &q = frames[frame][b];
                         bool overlap = true;
                         for (const int k : {0, 1}) overlap &= p.min[k] <= q.max[k] && q.min[k] <= p.max[k];
                         if (overlap)
                             list.push_back({static_cast<std::int64_t>(frame), static_cast<std::int64_t>(a),
                                             static_cast<std::int64_t>(b)});
                     }
         }},
    };
    for (const auto& [name, said, make] : damages) {
        CAPTURE(name);
        rows list = scene.pairs;
        make(list);
        const std::string text = said_of(scene.recording, folder.write("list.csv", text_of(list)));
        INFO(text);
        CHECK(holds(text, said));
        CHECK(holds(stored_text(name), said));
    }

    // Boxes that touch, and such as overlap a little.
    const std::string touching = folder.write("touching.csv", "0,0,0,1,1,1\n1,0,0,2,1,1\n1.5,0,0,3,1,1\n");
    const std::string open = "Every false negative touches without overlapping";
    CHECK(holds(said_of(touching, folder.write("list.csv", "1,2\n")), open));
    CHECK(holds(stored_text("touching pairs dropped"), open));
    const std::string apart = folder.write("apart.csv", "0,0,0,0.999999999,1,1\n1,0,0,2,1,1\n1.5,0,0,3,1,1\n");
    const std::string rounded = "Every wrong pair is right for boxes rounded to float";
    CHECK(holds(said_of(apart, folder.write("list.csv", "0,1\n1,2\n")), rounded));
    CHECK(holds(stored_text("boxes rounded to float"), rounded));
}
