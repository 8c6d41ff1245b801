module aabblab.checking;

import :box_classes;
import :comparison;
import aabb.registry;
import aabblab.fmt;
import aabblab.numbers;
import aabblab.progress;
import aabblab.stopwatch;

namespace aabblab {

check_result check_boxes(scene_frames& scene, const pair_list& list, const std::optional<nearness>& within) {
    if (!list.has_frames && scene.frames() > 1)
        throw aabb::input_error(fmt::format(
            "the list has no frames, but the scene has {}: expected the columns frame,a,b", grouped(scene.frames())));
    const auto objects = scene.objects();
    search_method method = method_of(
        {.stages = {aabb::stage::global_search}, .named = {}, .engine = {}, .within = within}, traits_of(scene));
    stage_runner searcher(std::move(method.run_stages), scene);
    double search_ms = 0;
    const wall_stopwatch preparing;
    list_comparison comparison(list, {scene.frames(), objects, objects, /*is_symmetric=*/true});
    double check_ms = preparing.ms();
    box_classes classes(within, scene.filter());
    progress shown("frames checked", scene.frames());
    run_frames(scene, searcher, [&](const searched_frame& frame) {
        search_ms += frame.ms();
        const frame_boxes boxes{scene.boxes(),
                                within && within->in_double ? within->in_double->in_double() : scene.boxes_in_double()};
        const wall_stopwatch checking;
        comparison.compare(frame.pairs, [&](const frame_errors& errors) { classes.add(errors, boxes); });
        check_ms += checking.ms();
        shown.update(frame.number + 1);
    });
    check_result result = comparison.result(classes.sentences());
    classes.add_to(result);
    result.search_ms = search_ms;
    result.check_ms = check_ms;
    return result;
}

}  // namespace aabblab
