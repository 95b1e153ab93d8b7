#include "tests/unit/render/decoded_video.hpp"

#include <array>

#include "render/media/libav.hpp"

namespace qsmpc::render {
namespace {

Image rgb_image(const AVFrame& frame) {
  Image image{frame.width, frame.height, {}};
  image.rgb.resize(static_cast<std::size_t>(3 * frame.width * frame.height));
  const libav::Pointer<SwsContext> scaler(sws_getContext(
      frame.width, frame.height, static_cast<AVPixelFormat>(frame.format), frame.width,
      frame.height, AV_PIX_FMT_RGB24, SWS_BILINEAR, nullptr, nullptr, nullptr));
  sws_setColorspaceDetails(scaler.get(), sws_getCoefficients(SWS_CS_ITU709), 0,
                           sws_getCoefficients(SWS_CS_DEFAULT), 1, 0, 1 << 16, 1 << 16);
  const std::array<unsigned char*, 1> planes{image.rgb.data()};
  const std::array<int, 1> strides{3 * frame.width};
  sws_scale(scaler.get(), frame.data, frame.linesize, 0, frame.height, planes.data(),
            strides.data());
  return image;
}

void receive_frames(AVCodecContext* codec, DecodedVideo& video) {
  const libav::Pointer<AVFrame> frame(av_frame_alloc());
  while (true) {
    const int code = avcodec_receive_frame(codec, frame.get());
    if (code == AVERROR(EAGAIN) || code == AVERROR_EOF) {
      return;
    }
    libav::check(code, "decode");
    if (video.frames == 0) {
      video.first = rgb_image(*frame);
      video.bt709 = frame->colorspace == AVCOL_SPC_BT709;
    }
    ++video.frames;
  }
}

}  // namespace

DecodedVideo decode_video(const std::string& path) {
  AVFormatContext* format = nullptr;
  libav::check(avformat_open_input(&format, path.c_str(), nullptr, nullptr), path);
  libav::check(avformat_find_stream_info(format, nullptr), path);
  const AVCodecParameters* const parameters = format->streams[0]->codecpar;
  const AVCodec* const decoder = avcodec_find_decoder(parameters->codec_id);
  const libav::Pointer<AVCodecContext> codec(avcodec_alloc_context3(decoder));
  libav::check(avcodec_parameters_to_context(codec.get(), parameters), path);
  libav::check(avcodec_open2(codec.get(), decoder, nullptr), path);
  DecodedVideo video;
  video.codec = decoder->name;
  video.width = parameters->width;
  video.height = parameters->height;
  video.duration = static_cast<double>(format->duration) / AV_TIME_BASE;
  const libav::Pointer<AVPacket> packet(av_packet_alloc());
  while (av_read_frame(format, packet.get()) >= 0) {
    libav::check(avcodec_send_packet(codec.get(), packet.get()), path);
    receive_frames(codec.get(), video);
    av_packet_unref(packet.get());
  }
  libav::check(avcodec_send_packet(codec.get(), nullptr), path);
  receive_frames(codec.get(), video);
  avformat_close_input(&format);
  return video;
}

}  // namespace qsmpc::render
