// Films by FFmpeg's libraries.
#include <algorithm>
#include <cerrno>
#include <cmath>

#include "dreampm/base/error.h"
#include "dreampm/video/encoder.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
#include <libswscale/swscale.h>
}

namespace dreampm {
namespace {

// libav prints on its own; errors are thrown here instead.
class QuietLibav {
 public:
  QuietLibav() : before_(av_log_get_level()) { av_log_set_level(AV_LOG_QUIET); }
  ~QuietLibav() { av_log_set_level(before_); }
  QuietLibav(const QuietLibav&) = delete;
  QuietLibav& operator=(const QuietLibav&) = delete;

 private:
  int before_;
};

// C objects that free themselves.
template <auto Free>
struct Freed {
  template <class T>
  void operator()(T* p) const {
    Free(&p);
  }
};
using Codec = std::unique_ptr<AVCodecContext, Freed<avcodec_free_context>>;
using Frame = std::unique_ptr<AVFrame, Freed<av_frame_free>>;
using Packet = std::unique_ptr<AVPacket, Freed<av_packet_free>>;
struct FreeScaler {
  void operator()(SwsContext* p) const { sws_freeContext(p); }
};
struct FreeContainer {
  void operator()(AVFormatContext* p) const {
    if (p->pb) avio_closep(&p->pb);
    avformat_free_context(p);
  }
};

class LibavEncoder final : public Encoder {
 public:
  explicit LibavEncoder(const FilmFile& film) : name_(film.target.string()) {
    AVFormatContext* container = nullptr;
    // The format by name: the temporary file's name does not show it.
    check(avformat_alloc_output_context2(&container, nullptr, "mp4", film.temporary.c_str()), "no mp4 writer");
    container_.reset(container);
    open_codec(film.width, film.height, film.settings);
    stream_ = avformat_new_stream(container, nullptr);
    if (!stream_) fail_run("{}: the video cannot be written: out of memory", name_);
    stream_->time_base = codec_->time_base;
    stream_->avg_frame_rate = codec_->framerate;
    check(avcodec_parameters_from_context(stream_->codecpar, codec_.get()), "stream parameters");
    check(avio_open(&container->pb, film.temporary.c_str(), AVIO_FLAG_WRITE), "opening the file");
    AVDictionary* options = nullptr;
    av_dict_set(&options, "movflags", "+faststart", 0);
    const int rc = avformat_write_header(container, &options);
    av_dict_free(&options);
    check(rc, "the header");
    make_frame(film.width, film.height);
  }

  void add(const RgbImage& picture) override {
    check(av_frame_make_writable(frame_.get()), "a frame");
    const std::uint8_t* rows[] = {picture.pixels.data()};
    const int stride[] = {picture.width * 3};
    sws_scale(scaler_.get(), rows, stride, 0, picture.height, frame_->data, frame_->linesize);
    frame_->pts = next_++;
    check(avcodec_send_frame(codec_.get(), frame_.get()), "encoding");
    drain();
  }

  void finish() override {
    check(avcodec_send_frame(codec_.get(), nullptr), "encoding");
    drain();
    check(av_write_trailer(container_.get()), "the index");
    check(container_->pb->error, "writing");
    check(avio_closep(&container_->pb), "closing the file");
  }

 private:
  void check(int rc, const char* doing) const {
    if (rc >= 0) return;
    char reason[AV_ERROR_MAX_STRING_SIZE] = {};
    av_strerror(rc, reason, sizeof reason);
    fail_run("{}: the video cannot be written ({}): {}", name_, doing, reason);
  }

  void open_codec(int width, int height, const VideoSettings& settings) {
    const AVCodec* encoder = avcodec_find_encoder_by_name("libx264");
    if (!encoder) fail_run("{}: this libavcodec has no libx264 encoder", name_);
    codec_.reset(avcodec_alloc_context3(encoder));
    if (!codec_) fail_run("{}: the video cannot be written: out of memory", name_);
    codec_->width = width;
    codec_->height = height;
    codec_->framerate = av_d2q(settings.fps, 1000000);
    codec_->time_base = av_inv_q(codec_->framerate);
    codec_->thread_count = 4;  // a fixed number: the film's bytes depend on it
    codec_->gop_size = group_size(settings.fps);
    codec_->pix_fmt = AV_PIX_FMT_YUV420P;
    codec_->color_range = AVCOL_RANGE_MPEG;
    codec_->colorspace = AVCOL_SPC_BT709;
    codec_->color_primaries = AVCOL_PRI_BT709;
    codec_->color_trc = AVCOL_TRC_BT709;
    if (container_->oformat->flags & AVFMT_GLOBALHEADER) codec_->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
    check(av_opt_set_int(codec_->priv_data, "crf", settings.quality, 0), "the quality");
    check(av_opt_set(codec_->priv_data, "preset", settings.quick ? "veryfast" : "medium", 0), "the preset");
    check(avcodec_open2(codec_.get(), encoder, nullptr), "opening libx264");
  }

  void make_frame(int width, int height) {
    frame_.reset(av_frame_alloc());
    packet_.reset(av_packet_alloc());
    if (!frame_ || !packet_) fail_run("{}: the video cannot be written: out of memory", name_);
    frame_->format = AV_PIX_FMT_YUV420P;
    frame_->width = width;
    frame_->height = height;
    frame_->color_range = codec_->color_range;
    frame_->colorspace = codec_->colorspace;
    frame_->color_primaries = codec_->color_primaries;
    frame_->color_trc = codec_->color_trc;
    check(av_frame_get_buffer(frame_.get(), 0), "a frame");
    scaler_.reset(sws_getContext(width, height, AV_PIX_FMT_RGB24, width, height, AV_PIX_FMT_YUV420P,
                                 SWS_BICUBIC | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INP, nullptr, nullptr, nullptr));
    if (!scaler_) fail_run("{}: no conversion from RGB to yuv420p", name_);
    // RGB of full range to BT.709 of limited range; the default would be BT.601.
    sws_setColorspaceDetails(scaler_.get(), sws_getCoefficients(SWS_CS_ITU709), 1, sws_getCoefficients(SWS_CS_ITU709),
                             0, 0, 1 << 16, 1 << 16);
  }

  void drain() {
    for (;;) {
      const int rc = avcodec_receive_packet(codec_.get(), packet_.get());
      if (rc == AVERROR(EAGAIN) || rc == AVERROR_EOF) return;
      check(rc, "encoding");
      // Without it the last frame lasts no time and 120 frames make 4.96 s.
      packet_->duration = 1;
      av_packet_rescale_ts(packet_.get(), codec_->time_base, stream_->time_base);
      packet_->stream_index = stream_->index;
      check(av_interleaved_write_frame(container_.get(), packet_.get()), "writing");
      check(container_->pb->error, "writing");
    }
  }

  QuietLibav quiet_;
  std::string name_;
  std::unique_ptr<AVFormatContext, FreeContainer> container_;
  Codec codec_;
  Frame frame_;
  Packet packet_;
  std::unique_ptr<SwsContext, FreeScaler> scaler_;
  AVStream* stream_ = nullptr;
  std::int64_t next_ = 0;
};

}  // namespace

std::unique_ptr<Encoder> open_libav_encoder(const FilmFile& film) { return std::make_unique<LibavEncoder>(film); }

}  // namespace dreampm
