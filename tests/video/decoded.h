// A film as its pictures.
#pragma once
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "dreampm/image.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/pixdesc.h>
#include <libswscale/swscale.h>
}

namespace dreampm::test {

struct Decoded {
  double container_seconds = 0, stream_seconds = 0, frames_a_second = 0;
  std::string codec, pixels;
  AVColorSpace space{};
  AVColorRange range{};
  std::vector<RgbImage> frames;
  std::vector<std::int64_t> times;
};

inline Decoded decode(const std::filesystem::path& file) {
  Decoded out;
  AVFormatContext* in = nullptr;
  EXPECT_EQ(avformat_open_input(&in, file.c_str(), nullptr, nullptr), 0);
  if (!in) return out;
  EXPECT_GE(avformat_find_stream_info(in, nullptr), 0);
  EXPECT_EQ(in->nb_streams, 1u);
  AVStream* stream = in->streams[0];
  out.container_seconds = static_cast<double>(in->duration) / AV_TIME_BASE;
  out.stream_seconds = static_cast<double>(stream->duration) * av_q2d(stream->time_base);
  out.frames_a_second = av_q2d(stream->avg_frame_rate);
  out.codec = avcodec_get_name(stream->codecpar->codec_id);
  out.pixels = av_get_pix_fmt_name(static_cast<AVPixelFormat>(stream->codecpar->format));
  out.space = stream->codecpar->color_space;
  out.range = stream->codecpar->color_range;
  AVCodecContext* codec = avcodec_alloc_context3(avcodec_find_decoder(stream->codecpar->codec_id));
  avcodec_parameters_to_context(codec, stream->codecpar);
  EXPECT_EQ(avcodec_open2(codec, nullptr, nullptr), 0);
  AVPacket* packet = av_packet_alloc();
  AVFrame* frame = av_frame_alloc();
  SwsContext* scaler = sws_getContext(codec->width, codec->height, AV_PIX_FMT_YUV420P, codec->width, codec->height,
                                      AV_PIX_FMT_RGB24, SWS_BICUBIC | SWS_ACCURATE_RND, nullptr, nullptr, nullptr);
  const int* bt709 = sws_getCoefficients(SWS_CS_ITU709);
  sws_setColorspaceDetails(scaler, bt709, 0, bt709, 1, 0, 1 << 16, 1 << 16);
  const auto take = [&] {
    while (avcodec_receive_frame(codec, frame) == 0) {
      RgbImage image(frame->width, frame->height);
      std::uint8_t* rows[] = {image.pixels.data()};
      const int stride[] = {frame->width * 3};
      sws_scale(scaler, frame->data, frame->linesize, 0, frame->height, rows, stride);
      out.frames.push_back(std::move(image));
      out.times.push_back(frame->pts);
    }
  };
  while (av_read_frame(in, packet) == 0) {
    avcodec_send_packet(codec, packet);
    av_packet_unref(packet);
    take();
  }
  avcodec_send_packet(codec, nullptr);
  take();
  sws_freeContext(scaler);
  av_frame_free(&frame);
  av_packet_free(&packet);
  avcodec_free_context(&codec);
  avformat_close_input(&in);
  return out;
}

}  // namespace dreampm::test
