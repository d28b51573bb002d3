#pragma once
/// Small LAZ files, and the LAS files that they were. The compressed bytes were written by laspy 2.7 with lazrs 0.8
/// from the records that laz_record() makes; all else is made here.
#include "tests/support/ply_bytes.h"
#include <cstdint>
#include <vector>

namespace pointgi::test {

constexpr int laz_points = 60;

struct LazSample {
  int format;              ///< of the points; each has two extra bytes
  std::string description; ///< content of the record "laszip encoded", in hexadecimal digits
  std::string chunk;       ///< the points
  std::string table;       ///< of the one chunk
};

inline const std::vector<LazSample>& laz_samples() {
  static const std::vector<LazSample> samples{
      {3,
       "02000000020200000000000050c30000ffffffffffffffffffffffffffffffff04000600140002000700080002000800060002000000"
       "02000200",
       "000000000000000000000000000011000000010000000000007097400000000000000000d048f4795cbc72da0687dc43927000008d75"
       "5b607476cb1c1be63cfafa08a1b2e16e8f44922e8000c7d02653cf9fe2942fc50ae9911437a4248876c775bec0006ebd3c21ede5420c"
       "20ef3ea911689bde172f8aa9ff607100001ee4351aa6b9420a7cfe8bdcc5dbaa3eefa5d8da0b0480001152c06c9497b2cbe42857da68"
       "73515e77c86cd326c5c00013665cbd53af77828f3bbe4ce2e2881919692e49da40004b30e692018182b00af8898cb88282ac00f33ea6"
       "d86000000a2d178294a9a3598f92a699c1730d92a6fd4e52a7800156bfbadbff6f249f9038d29cb0b11b968c0e998240000168bc5b6e"
       "211491cb984b6fad29fcfa2f1f518d1900002ba4d0c49fc7e70484abcbabbcbc27e53cdeaa64e700002351609e805ad3433a09836988"
       "05e52fb73051a680000e594f345fe359440e0f5d5a05157ff130c205fe0500004645d2aa45c7034f7bf4fbf30e6699ce29a268970000"
       "486a6bcb87308f462bbd20c882dc28f338f5efc0e89f413800024d9172ace97b52d6ec60af6a5e9016147406d16938000012c47b184c"
       "fe550a67aeb4c7b2f7b784e3d5a0f50000c350002f304845d864bf3ed2d75fb386a5c18500000db96d2f46cf4cf0d86fa2a28eaae726"
       "1eda99dab4e0c9000dbe6c3f8876bd1bb2e461934c33ca09b0719b1ffa001a3c14a4b4db595218fcb7e86e2bcb224c62a20f0002a081"
       "e0170b4f9bb61a47258bdcefb8a87e07bc00005e145bd41cc4c04566cee929158bc9352e03f9d59f0002069ec42985a32e4895509a68"
       "5df7f59c648831400055f6e169771764478f3aa6c60cd6ce43c1b91ada00058ff4fd23991dc959cf19ffea6510a22c35286b830000f4"
       "6607bd7efeb4113e9f06de2d86f4be9f945496360027d288630c656d79183cdceb5c8622d84568c7c0004f2d274286d7f3d1c13b66be"
       "64db6496f683ac4d80003099e2fa393088c68f7125052ff279d995c887d7001c40b3c528bb0c364992d71af7520501c081ef329129e8"
       "000054083e29eead9081ff1047f52e8e6d0a6eb3b4f38800002a700ab0a1e56b2e81351a63a8fc641ac581eb796e000feb03e117c0f4"
       "6732ae0bd4703d21c36249dfed000b84d70d7a397e0144d928d0a1d63b370243f1da0000bb089dec2af22599bc5a1a1cd10cab91e9fe"
       "40002a121c752323270a6f0744b842631cd9b38e95000142c37a3b44d6f743438a11ebe0022a51b3c35600019eb23d254051cfcfac74"
       "31845b343ad7ddc2441450e69c00014bc1ca844d639884e969602579ad52b298e4c0003b51e0716362b7284b1a7e680bfe256c259f66"
       "000a8b05e57ca0bc3f9d797bf79d080aa4c322cb000183b749924dc5f499ad850cf582c44da0759751e00006c6bab6fd8e84f22bf845"
       "730dc1e24faf479a0000badef1eb5fe00d028881c31fa24a01748b057e000c11bca141a380065646bc4c70e931672969b27000040b3d"
       "e8546657cb20bfbbbea4a52ab95ac4b40af69d600001a1b1ad3bce238d824141e992180eed95ceecdd20000066ccb941e1a831283662"
       "885b4580c3c8152ad580003481279a14bcaa65b9bb2e7d1b9e25ea64fa00005dbd6c2869497a1decaba52a49e87d8edd3c6a27000116"
       "cbb8d52dc68106832fc982318c11f7b361c000464dd12a86a6a35a6d7f21ca2cc95b279d9240007be4c451a1bdd3aae53f36286e5c69"
       "a429bf000648d252f6769c13dd5e489093e50a0952cfda6ffd00061cda919afe7f998a0b75dfe3872b72fcf4640015100ceae8c09bcd"
       "6bc1a9af93c6c92dd0000004ba1d1653c49f3be0113b94e8351e5c07129dd00039b72d745e8201a04f55000000",
       "00000000010000005a66f1000000"},
      {8, "03000000020200000000000050c30000ffffffffffffffffffffffffffffffff03000a001e0003000c00080003000e0002000300",
       "00000000000000000000000000002100000060f001000000000000709740000000000000000000003c000000dc0000005a0000003f00"
       "00003000000052000000640000003f0000000b0000006901000099010000600000003f0000003f00000032aa1f865b8409fe56ce9eca"
       "6509552dad6bb54d2f97285d997589ae6cfd008c651165f279b7d0e00115bd02061ef705b3c87a81de8117933fc60da44953a8056f6f"
       "df589945a148599af88990c5cec20fd98edb2b9550f5ab897ee6812479c3e91a5b3873ef7a49561dbea359f9b5f1bf6dcbd179f7a5fc"
       "e006362d19689fb8c4af956350551bd26e5c519af822600cac9060952acdbe53c610aef67745ec2d21e7eb2af096c86748258631257a"
       "427e809dd7e616976d6d5062cb50099499f3f4e6f78189a3ed98d81077cb4f250af575387d0faf46991a8e5f000024f0a23ea1d249c3"
       "40dcfcd15af819c6081c524fbfd321f64cbeb1cb489bae51bfa80c8e9d94ffc2fd9d091828de1eb941ee786ccd2f841a3061ebba9601"
       "7374d002ebb89430f879776296a5e0213fedaa89c7d70b8f680000000000000000000001010080808080808181810101010101020201"
       "8181818181828282020202020203030282828282828383830303030302fcfd00000100000004003e3cfbafb9f7bffc03cfbafb9f7bff"
       "c03cfbafb9f7bffc03cfbafb9f7bffc03cfbafb9f7bffc03cfbafba00000005999b466069b018b17fb3d56e0386eeb6d871b458e4d49"
       "eac20ea2a6e67860d463a8d03ac46cbe1bbb465c539775d2d01398240a0a88a3f67a85a16380204a123d2db250061439b4906877e733"
       "f763000000a0de88fc657725906378a1913b2dc647ceb293710c95480ffae75aab444cd9aa97f1819a382c47923fa0225055787ba2eb"
       "2225f82e589307e00f1dc1caa133e22e25055fa68079036dc4191013198fac66f3eb035c34487a65e28c02f45d2df173000000000000"
       "0101008081818100feff00000101008081818100feff00000101008081818100feff00000101008081818100feff0000010100808181"
       "8100ff00000007c15158b098ccd200000052fbb9133000000677077800000511a574c00003f7e0aa0000031af16a000002715f1a4000"
       "01ed3b30800001897666c000013d1e884a000101f81f130000dd2b5c400001ea12e7c000018a6a054000013978b24d0000f78bc13a80"
       "00f1434fb1e00000221559d2080000075c92ff400000dbc2dcc00002050096800004bfbb1ac0000b1e6205c00019f1719f80004fe51a"
       "6800000952e2e6c00015c37d31000034ad99570000852c900000014b108d000004a306003c00008a4e70400002260fc5fd9800009fc0"
       "08abb000001bb2d3d480004628fcd100010b3f3ae8000025665bb2000070fcce0000014e8aa3000003d6eafac0000b34bb3400002a6d"
       "8260000005ef4035800011552f2f0000362cbe8f00009d9a69800001d1470c800009b8633c1ff800034e4b4562e00001689d88c00004"
       "28672b40000c1ddfd2800023483f0e800089028dd40000136f7631800060965a10000c54ef600001a1f4a840003523e9e80001000000"
       "ffcf871bf5fc03ffa01037e7f807ff40206907f7dffe8040dd2fe07ffd0081bf3fc03ffa010351ffbd7ff40206d5ff06ffb80c27ecfa"
       "03ffd0081addfddfffa0103613f84fff401c43d7f80ffe8040d95feeaffd0081abbfc31fee0309fb3e80fff40206de7f727fe8040d36"
       "fe1effd0081bf3fc03ffa010378ffb7bff4020687ff127fe8040df9fe01ffd0081a15fdb1ffa00c3da7fcabff40201fcff00ffe804f8"
       "f9fdd3fea08ddc17ba25ff40206aeff0c7ff40206ac7f667fe8040d9afe36ffd0081bf3fc03ffa01035fffb1bfa823d5c5ee097fd008"
       "1a6dfc3dffd0072c4fff83ffa0103533f907ff40206fcff00ffe8040dcdfebbffd0081a4bfc8fffa01037e7f807ff40206fa7f5affe8"
       "040dfefe4dffd0081bf3fc03ffa010346ffabffa8231445ef08ffd0071d51fd54ffd0081a85fd55ffa0101ac3f963ff4027dccfe817f"
       "e8040d69fea3fea08dd417ba25ff40206a0ff183ff40206c87f4effe8040d62fe65ffd0081bf3fc03ffa00ebce3fe63ff402069dff35"
       "7fe8040df9fe01ffd0081bbdfd25ffa0103453f9c3ff40206fcff00900000053548e708617b32a72e7c84f440eb6ce7201722b6a3ac4"
       "2265ca638aa388cf90a3c004922331125a996a8d0d93bbe428792e71152dc3dafc21889dfce3314f2cd20644757821b22eca0603317e"
       "5a9ed81df94759283f4a6cce85637b8a00000001030485868788a18a7f8c8d8ebf90799293949596979899a9cc95051e9f7bf6b4f924"
       "a5a6a7a8a9aaac3802810524b222147d0536b7d0b9aebbbc4700000000000000000000000000000000000000ffff800000000100017f"
       "ff00ffff83fcfe018000ffff80ffff800101fc7f0181fdff02000080fc7f81810000000000",
       "00000000010000005c0201000000"},
  };
  return samples;
}

inline std::string from_hex(const std::string& digits) {
  std::string bytes;
  for (std::size_t i = 0; i < digits.size(); i += 2)
    bytes += static_cast<char>(std::stoi(digits.substr(i, 2), nullptr, 16));
  return bytes;
}

/// Record `i` of point format 3, or 8 with three scanner channels.
inline std::string laz_record(int format, int i) {
  const bool is_new = format >= 6;
  const auto u8 = [](int value) { return std::string(1, static_cast<char>(value)); };
  const auto u16 = [](int value) { return bytes_of(static_cast<std::uint16_t>(value)); };
  std::string bytes;
  for (const int coordinate : {1000 * i + i * i * 7 % 50, -500 * i + i * 3 % 20, i * i * 13 % 300})
    bytes += bytes_of(static_cast<std::int32_t>(coordinate));
  const int number = 1 + i % 2, side = i / 5 % 2 << 6, red = i * 1000 % 65536, green = red / 2 + i;
  bytes += u16(i * 31 % 200);
  if (is_new)
    bytes += u8(number | 2 << 4) + u8(i % 2 | (i / 6 % 3) << 4 | side) + u8(i / 8 % 7) + u8(i / 4 % 3) +
             u16(i * 700 % 9000 - 4000);
  else
    bytes += u8(number | 2 << 3 | side) + u8(i / 8 % 7) + u8(i % 10) + u8(i / 4 % 3);
  bytes += u16(i / 10 % 4 + 1) + bytes_of(1000.0 + 0.25 * i + (i % 16 == 0 ? 500.0 : 0.0));
  bytes += u16(red) + u16(green) + u16(i % 3 != 0 ? red : green);
  if (is_new) bytes += u16(i * 77 % 1000);
  return bytes + u16(i * i % 1000);
}

/// The file, its points compressed or not.
inline std::string laz_file(const LazSample& sample, bool compressed) {
  const bool is_new = sample.format >= 6;
  const std::size_t header_bytes = is_new ? 375 : 227;
  const std::string description = from_hex(sample.description);
  const std::size_t begin = header_bytes + 54 + description.size();
  std::string bytes(header_bytes, '\0');
  const auto put = [&](std::size_t place, const std::string& value) { bytes.replace(place, value.size(), value); };
  put(0, "LASF");
  put(24, std::string(1, '\1') + (is_new ? "\4" : "\2"));
  put(94, bytes_of(static_cast<std::uint16_t>(header_bytes)) + bytes_of(static_cast<std::uint32_t>(begin)) +
              bytes_of<std::uint32_t>(1));
  put(104, std::string(1, static_cast<char>(sample.format | (compressed ? 0x80 : 0))) +
               bytes_of(static_cast<std::uint16_t>(laz_record(sample.format, 0).size())) +
               bytes_of<std::uint32_t>(is_new ? 0 : laz_points));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    put(131 + 8 * axis, bytes_of(0.001));
    put(155 + 8 * axis, bytes_of(1000.0));
  }
  if (is_new) put(247, bytes_of<std::uint64_t>(laz_points));
  bytes += std::string(2, '\0') + std::string("laszip encoded\0\0", 16) + bytes_of<std::uint16_t>(22204) +
           bytes_of(static_cast<std::uint16_t>(description.size())) + std::string(32, '\0') + description;
  if (compressed) {
    const std::string chunk = from_hex(sample.chunk);
    return bytes + bytes_of<std::uint64_t>(begin + 8 + chunk.size()) + chunk + from_hex(sample.table);
  }
  for (int i = 0; i < laz_points; ++i)
    bytes += laz_record(sample.format, i);
  return bytes;
}

} // namespace pointgi::test
