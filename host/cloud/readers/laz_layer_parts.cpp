#include "host/cloud/readers/laz_items.h"
#include <algorithm>
#include <cstring>

namespace pointgi {

namespace {

using laz_detail::even;
using laz_detail::folded;

constexpr std::size_t channels = 4; // of scanners; each has its own last point and models

/// Contexts of returns: r of n.
unsigned return_context(unsigned n, unsigned r) {
  constexpr unsigned char of_zero[16] = {0, 1, 2, 3, 4, 5, 3, 4, 4, 5, 5, 5, 5, 5, 5, 5};
  const unsigned low = std::min(n, r), high = std::max(n, r);
  if (low == 0) return of_zero[high];
  if (low == 1) return high <= 2 ? high - 1 : 3;
  if (low == 2) return high == 2 ? 2 : high <= 10 ? 4 : 3;
  return high == low || (high == low + 1 && low >= 11) ? 5 : 4;
}

/// The fields of point formats 6 to 10 that all of them begin with.
struct Point14 {
  std::int32_t x = 0, y = 0, z = 0;
  std::uint16_t intensity = 0;
  unsigned char r = 0, n = 0; ///< return r of n
  unsigned char flags = 0;    ///< class flags, then the scan's direction, then the edge of a flight line
  unsigned char channel = 0, classification = 0, user = 0;
  std::int16_t angle = 0;
  std::uint16_t source = 0;
  std::int64_t time = 0; ///< the bits of a double
  bool time_changed = false;

  void load(const unsigned char* bytes) {
    std::memcpy(&x, bytes, 4);
    std::memcpy(&y, bytes + 4, 4);
    std::memcpy(&z, bytes + 8, 4);
    std::memcpy(&intensity, bytes + 12, 2);
    r = bytes[14] & 15;
    n = bytes[14] >> 4;
    flags = static_cast<unsigned char>((bytes[15] & 15) | (bytes[15] >> 6 & 3) << 4);
    channel = bytes[15] >> 4 & 3;
    classification = bytes[16];
    user = bytes[17];
    std::memcpy(&angle, bytes + 18, 2);
    std::memcpy(&source, bytes + 20, 2);
    std::memcpy(&time, bytes + 22, 8);
    time_changed = false;
  }
  void store(unsigned char* bytes) const {
    std::memcpy(bytes, &x, 4);
    std::memcpy(bytes + 4, &y, 4);
    std::memcpy(bytes + 8, &z, 4);
    std::memcpy(bytes + 12, &intensity, 2);
    bytes[14] = static_cast<unsigned char>(n << 4 | r);
    bytes[15] = static_cast<unsigned char>((flags & 15) | channel << 4 | (flags >> 4) << 6);
    bytes[16] = classification;
    bytes[17] = user;
    std::memcpy(bytes + 18, &angle, 2);
    std::memcpy(bytes + 20, &source, 2);
    std::memcpy(bytes + 22, &time, 8);
  }
};

/// What is kept of one scanner channel.
struct PointContext {
  explicit PointContext(const Point14& point) : last(point), times(false, point.time) {
    heights.fill(point.z);
    intensities.fill(point.intensity);
  }
  Point14 last;
  LazModels changed{8, 128}, return_count{16, 16}, return_number{16, 16}, classification{64, 256}, flags{64, 64},
      user{64, 256};
  LazModel channel{3}, return_same_time{13};
  LazIntegers x{32, 2}, y{32, 22}, z{32, 20}, intensity{16, 4}, angle{16, 2}, source{16};
  LazTimes times;
  std::array<LazMedian, 12> x_medians{}, y_medians{};
  std::array<std::int32_t, 8> heights{};
  std::array<std::uint16_t, 8> intensities{};
};

class PointPart : public LazLayerPart {
public:
  std::size_t layers() const override { return layer_count; }

  void begin(const unsigned char* bytes, unsigned channel) override {
    for (auto& context : contexts_)
      context.reset();
    Point14 point;
    point.load(bytes);
    contexts_[channel] = std::make_unique<PointContext>(point);
    now_ = channel;
  }

  void next(LazLayer* layer, unsigned& channel, unsigned char* bytes) override {
    const unsigned changed = next_place(layer[in_plane].decoder);
    PointContext& context = *contexts_[now_];
    Point14& point = context.last;
    const unsigned first_last = (point.r == 1 ? 2u : 0u) + (point.r >= point.n ? 1u : 0u);
    next_values(layer, context, changed, first_last);
    // The other parts hear of the channel only where it changes: what the first encoder did is the format.
    channel = (changed & channel_changed) == 0 ? 0 : now_;
    point.store(bytes);
  }

private:
  enum Layer : std::size_t {
    in_plane, // and channel and returns
    height,
    classification,
    flags,
    intensity,
    angle,
    user,
    source,
    time,
    layer_count
  };
  enum Change : unsigned { angle_changed = 8, time_changed = 16, source_changed = 32, channel_changed = 64 };

  /// Channel, returns, x and y. Returns what changed.
  unsigned next_place(LazDecoder& decoder) {
    PointContext* context = contexts_[now_].get();
    const Point14& before = context->last;
    const unsigned kind =
        (before.r == 1 ? 1u : 0u) + (before.r >= before.n ? 2u : 0u) + (before.time_changed ? 4u : 0u);
    const unsigned changed = decoder.symbol(context->changed[kind]);
    if ((changed & channel_changed) != 0) {
      now_ = (now_ + decoder.symbol(context->channel) + 1) % channels;
      if (!contexts_[now_]) contexts_[now_] = std::make_unique<PointContext>(before);
      context = contexts_[now_].get();
      context->last.channel = static_cast<unsigned char>(now_);
    }
    Point14& point = context->last;
    point.time_changed = (changed & time_changed) != 0;
    next_returns(decoder, *context, changed);
    const unsigned place = return_context(point.n, point.r) << 1 | (point.time_changed ? 1u : 0u);
    const unsigned single = point.n == 1 ? 1 : 0;
    move(point.x, context->x.decode(decoder, context->x_medians[place].get(), single), context->x_medians[place]);
    move(point.y,
         context->y.decode(decoder, context->y_medians[place].get(), single + even(context->x.last_bits(), 20)),
         context->y_medians[place]);
    return changed;
  }

  static void next_returns(LazDecoder& decoder, PointContext& context, unsigned changed) {
    Point14& point = context.last;
    if ((changed & 4) != 0) point.n = folded(decoder.symbol(context.return_count[point.n]));
    const unsigned before = point.r;
    unsigned number = before;
    if ((changed & 3) == 1)
      number = before + 1;
    else if ((changed & 3) == 2)
      number = before + 15;
    else if ((changed & 3) == 3)
      number = point.time_changed ? decoder.symbol(context.return_number[before])
                                  : before + decoder.symbol(context.return_same_time) + 2;
    point.r = static_cast<unsigned char>(number % 16);
  }

  static void move(std::int32_t& coordinate, std::int32_t difference, LazMedian& median) {
    coordinate =
        static_cast<std::int32_t>(static_cast<std::uint32_t>(coordinate) + static_cast<std::uint32_t>(difference));
    median.add(difference);
  }

  /// The attributes of layers of their own.
  static void next_values(LazLayer* layer, PointContext& context, unsigned changed, unsigned first_last) {
    Point14& point = context.last;
    const unsigned with_time = point.time_changed ? 1 : 0;
    if (!layer[height].is_empty) {
      const unsigned bits = (context.x.last_bits() + context.y.last_bits()) / 2;
      std::int32_t& last = context.heights[std::min(laz_return_level(point.n, point.r), 7u)];
      point.z = last = context.z.decode(layer[height].decoder, last, (point.n == 1 ? 1 : 0) + even(bits, 18));
    }
    if (!layer[classification].is_empty)
      point.classification = folded(layer[classification].decoder.symbol(
          context.classification[(point.classification & 31u) << 1 | (first_last == 3 ? 1u : 0u)]));
    if (!layer[flags].is_empty) point.flags = folded(layer[flags].decoder.symbol(context.flags[point.flags]));
    if (!layer[intensity].is_empty) {
      std::uint16_t& last = context.intensities[first_last << 1 | with_time];
      point.intensity = last =
          static_cast<std::uint16_t>(context.intensity.decode(layer[intensity].decoder, last, first_last));
    }
    if (!layer[angle].is_empty && (changed & angle_changed) != 0)
      point.angle = static_cast<std::int16_t>(context.angle.decode(layer[angle].decoder, point.angle, with_time));
    if (!layer[user].is_empty) point.user = folded(layer[user].decoder.symbol(context.user[point.user / 4u]));
    if (!layer[source].is_empty && (changed & source_changed) != 0)
      point.source = static_cast<std::uint16_t>(context.source.decode(layer[source].decoder, point.source));
    if (!layer[time].is_empty && point.time_changed) point.time = context.times.next(layer[time].decoder);
  }

  std::array<std::unique_ptr<PointContext>, channels> contexts_;
  unsigned now_ = 0;
};

/// Parts of which each channel keeps the last bytes and its models.
template <class Models>
class BytesPart : public LazLayerPart {
public:
  explicit BytesPart(std::size_t bytes) : bytes_(bytes) {}
  std::size_t layers() const override { return Models::layers(bytes_); }

  void begin(const unsigned char* bytes, unsigned channel) override {
    for (auto& context : contexts_)
      context.reset();
    contexts_[channel] = std::make_unique<Context>(bytes, bytes_);
    now_ = channel;
  }

  void next(LazLayer* layer, unsigned& channel, unsigned char* bytes) override {
    std::vector<unsigned char>* last = &contexts_[now_]->last;
    if (now_ != channel) {
      now_ = channel;
      // A channel that was met before goes on from the last point of the other one, and changes that; as above.
      if (contexts_[now_] == nullptr) {
        contexts_[now_] = std::make_unique<Context>(last->data(), bytes_);
        last = &contexts_[now_]->last;
      }
    }
    contexts_[now_]->models.next(layer, last->data(), bytes_);
    std::memcpy(bytes, last->data(), bytes_);
  }

private:
  struct Context {
    Context(const unsigned char* bytes, std::size_t count) : last(bytes, bytes + count), models(count) {}
    std::vector<unsigned char> last;
    Models models;
  };
  std::array<std::unique_ptr<Context>, channels> contexts_;
  std::size_t bytes_;
  unsigned now_ = 0;
};

struct ColourModels {
  explicit ColourModels(std::size_t) {}
  static std::size_t layers(std::size_t) { return 1; }
  void next(LazLayer* layer, unsigned char* last, std::size_t) {
    if (!layer[0].is_empty) colour.next(layer[0].decoder, last, last);
  }
  LazColour colour;
};

/// Red, green, blue, and near infrared in a layer of its own.
struct InfraredModels {
  explicit InfraredModels(std::size_t) {}
  static std::size_t layers(std::size_t) { return 2; }
  void next(LazLayer* layer, unsigned char* last, std::size_t) {
    if (!layer[0].is_empty) colour.next(layer[0].decoder, last, last);
    if (layer[1].is_empty) return;
    const std::uint32_t changed = layer[1].decoder.symbol(used);
    if ((changed & 1) != 0) last[6] = folded(last[6] + layer[1].decoder.symbol(low));
    if ((changed & 2) != 0) last[7] = folded(last[7] + layer[1].decoder.symbol(high));
  }
  LazColour colour;
  LazModel used{4}, low{256}, high{256};
};

/// A layer each.
struct ExtraModels {
  explicit ExtraModels(std::size_t bytes) : models(bytes, LazModel(256)) {}
  static std::size_t layers(std::size_t bytes) { return bytes; }
  void next(LazLayer* layer, unsigned char* last, std::size_t bytes) {
    for (std::size_t k = 0; k < bytes; ++k)
      if (!layer[k].is_empty) last[k] = folded(last[k] + layer[k].decoder.symbol(models[k]));
  }
  std::vector<LazModel> models;
};

} // namespace

std::unique_ptr<LazLayerPart> make_layer_part(const LazItem& item) {
  if (item.version != 3) return nullptr;
  if (item.type == 10 && item.bytes == 30) return std::make_unique<PointPart>();
  if (item.type == 11 && item.bytes == 6) return std::make_unique<BytesPart<ColourModels>>(item.bytes);
  if (item.type == 12 && item.bytes == 8) return std::make_unique<BytesPart<InfraredModels>>(item.bytes);
  if (item.type == 14) return std::make_unique<BytesPart<ExtraModels>>(item.bytes);
  return nullptr;
}

} // namespace pointgi
