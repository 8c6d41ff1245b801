module aabb.auto_detector;

namespace aabb {

namespace {

/// The kind of strategy of this name; throws input_error with the nearest name if there is none.
strategy_kind kind_named(std::string_view name) {
    std::vector<std::string> names;
    for (const strategy_kind kind : strategy_kinds) {
        if (name_of(kind) == name) return kind;
        names.emplace_back(name_of(kind));
    }
    throw input_error(unknown_name("kind of strategy", name, names));
}

/// Parses KIND=NAME:parameter=value,… for each text, and rejects a kind that is named twice.
named_strategies parse_choices(const std::vector<std::string>& texts) {
    named_strategies named;
    for (const std::string& text : texts) {
        const std::size_t equals = text.find('=');
        if (equals == std::string::npos)
            throw input_error("'" + text + "' is not of the form kind=strategy, as in sort=shell");
        auto& choice = named[kind_named(std::string_view(text).substr(0, equals))];
        if (choice) throw input_error(text.substr(0, equals) + " is named twice");
        choice = parse_strategy(std::string_view(text).substr(equals + 1));
    }
    return named;
}

named_strategies parse_choices_for_boxes(const std::vector<std::string>& texts) {
    named_strategies named = parse_choices(texts);
    for (const strategy_kind kind : kinds_of(stage::local_detection))
        if (named[kind]) throw input_error(std::string(name_of(kind)) + " is named, but objects are boxes");
    return named;
}

}  // namespace

struct auto_detector::mesh_part {
    mesh_part(std::vector<mesh> meshes, std::vector<std::uint32_t> mesh_of, global_stage& global,
              std::unique_ptr<local_stage> detection)
        : scene(std::move(meshes), std::move(mesh_of)), local(std::move(detection)), stages(scene, global, *local) {}

    given_scene scene;
    std::unique_ptr<local_stage> local;
    pipeline stages;
};

auto_detector::auto_detector(const std::vector<std::string>& named, std::size_t frames, const collision_filter* filter)
    : auto_detector(parse_choices_for_boxes(named), scene_traits{.frames = frames}, filter) {
    if (const std::string sentence = needs_meshes(composed_of(selected_)); !sentence.empty())
        throw input_error(sentence);
    std::erase_if(selected_,
                  [](const selected_strategy& s) { return info_of(s.kind).stage == stage::local_detection; });
}

auto_detector::auto_detector(std::vector<mesh> meshes, std::vector<std::uint32_t> mesh_of,
                             const std::vector<std::string>& named, std::size_t frames, const collision_filter* filter)
    : auto_detector(parse_choices(named), traits_of(meshes, mesh_of.size(), frames), filter) {
    meshes_ = std::make_unique<mesh_part>(std::move(meshes), std::move(mesh_of), *global_,
                                          compose_local_detection(composed_of(selected_), instrumentation::none));
}

auto_detector::auto_detector(const named_strategies& named, const scene_traits& scene, const collision_filter* filter)
    : selected_(select_strategies(named, scene)),
      global_(compose_global_search(composed_of(selected_), instrumentation::none)) {
    if (filter) global_ = filtered(std::move(global_), *filter);
    global_->expect(scene.frames);
}

auto_detector::~auto_detector() = default;

void auto_detector::insert(std::uint32_t object) {
    meshes_ ? meshes_->stages.insert(object) : global_->insert(object);
}

void auto_detector::remove(std::uint32_t object) {
    meshes_ ? meshes_->stages.remove(object) : global_->remove(object);
}

void auto_detector::moved(std::span<const std::uint32_t> objects) {
    if (meshes_) throw input_error("this detector is for meshes: their poses say which of them move");
    global_->moved(objects);
}

std::span<const index_pair> auto_detector::pairs(std::span<const box> boxes) {
    if (meshes_) throw input_error("this detector is for meshes: call contacts with their poses");
    global_->update(boxes);
    pairs_.clear();
    global_->search(pairs_);
    return pairs_;
}

pipeline& auto_detector::find_candidates(std::span<const pose> poses) {
    if (!meshes_) throw input_error("this detector is for boxes: construct one with meshes to find contacts");
    meshes_->stages.update(poses);
    meshes_->stages.search();
    return meshes_->stages;
}

std::span<const contact> auto_detector::contacts(std::span<const pose> poses) {
    pipeline& stages = find_candidates(poses);
    stages.detect();
    return stages.contacts();
}

std::optional<contact> auto_detector::first_contact(std::span<const pose> poses) {
    return find_candidates(poses).first_contact();
}

std::uint64_t auto_detector::count_contacts(std::span<const pose> poses) {
    return find_candidates(poses).count_contacts();
}

std::vector<part_bytes> auto_detector::bytes() const {
    std::vector<part_bytes> parts = global_->bytes();
    if (meshes_)
        for (part_bytes& part : meshes_->local->bytes()) parts.push_back(std::move(part));
    const std::size_t of_stages = meshes_ ? meshes_->stages.bytes() + meshes_->stages.division_bytes() : 0;
    const std::size_t buffers = bytes_of(pairs_) + of_stages;
    parts.push_back({"buffers", buffers});
    return parts;
}

std::vector<omission> auto_detector::left_out() const {
    return left_out_by(global_.get(), meshes_ ? meshes_->local.get() : nullptr);
}

}  // namespace aabb
