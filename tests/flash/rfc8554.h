// rfc8554.h - vectors of RFC 8554, appendix F, in hexadecimal.
#pragma once

namespace rfc8554 {

// Test case 1, the upper of its two levels: LMS_SHA256_M32_H5, LMOTS_SHA256_N32_W8. It signs the lower level's public key.
inline const char case1_key[] = "0000000500000004"
                                "61a5d57d37f5e46bfb7520806b07a1b8"
                                "50650e3b31fe4a773ea29a07f09cf2ea30e579f0df58ef8e298da0434cb2b878";
inline const char case1_message[] = "0000000500000004"
                                    "d2f14ff6346af964569f7d6cb880a1b6"
                                    "6c5004917da6eafe4d9ef6c6407b3db0e5485b122d9ebe15cda93cfec582d7ab";
inline const char case1_signature[] = "0000000500000004"
                                      "d32b56671d7eb98833c49b433c272586bc4a1c8a8970528ffa04b966f9426eb9"
                                      "965a25bfd37f196b9073f3d4a232feb69128ec45146f86292f9dff9610a7bf95"
                                      "a64c7f60f6261a62043f86c70324b7707f5b4a8a6e19c114c7be866d488778a0"
                                      "e05fd5c6509a6e61d559cf1a77a970de927d60c70d3de31a7fa0100994e162a2"
                                      "582e8ff1b10cd99d4e8e413ef469559f7d7ed12c838342f9b9c96b83a4943d16"
                                      "81d84b15357ff48ca579f19f5e71f18466f2bbef4bf660c2518eb20de2f66e3b"
                                      "14784269d7d876f5d35d3fbfc7039a462c716bb9f6891a7f41ad133e9e1f6d95"
                                      "60b960e7777c52f060492f2d7c660e1471e07e72655562035abc9a701b473ecb"
                                      "c3943c6b9c4f2405a3cb8bf8a691ca51d3f6ad2f428bab6f3a30f55dd9625563"
                                      "f0a75ee390e385e3ae0b906961ecf41ae073a0590c2eb6204f44831c26dd768c"
                                      "35b167b28ce8dc988a3748255230cef99ebf14e730632f27414489808afab1d1"
                                      "e783ed04516de012498682212b07810579b250365941bcc98142da13609e9768"
                                      "aaf65de7620dabec29eb82a17fde35af15ad238c73f81bdb8dec2fc0e7f93270"
                                      "1099762b37f43c4a3c20010a3d72e2f606be108d310e639f09ce7286800d9ef8"
                                      "a1a40281cc5a7ea98d2adc7c7400c2fe5a101552df4e3cccfd0cbf2ddf5dc677"
                                      "9cbbc68fee0c3efe4ec22b83a2caa3e48e0809a0a750b73ccdcf3c79e6580c15"
                                      "4f8a58f7f24335eec5c5eb5e0cf01dcf4439424095fceb077f66ded5bec73b27"
                                      "c5b9f64a2a9af2f07c05e99e5cf80f00252e39db32f6c19674f190c9fbc506d8"
                                      "26857713afd2ca6bb85cd8c107347552f30575a5417816ab4db3f603f2df56fb"
                                      "c413e7d0acd8bdd81352b2471fc1bc4f1ef296fea1220403466b1afe78b94f7e"
                                      "cf7cc62fb92be14f18c2192384ebceaf8801afdf947f698ce9c6ceb696ed70e9"
                                      "e87b0144417e8d7baf25eb5f70f09f016fc925b4db048ab8d8cb2a661ce3b57a"
                                      "da67571f5dd546fc22cb1f97e0ebd1a65926b1234fd04f171cf469c76b884cf3"
                                      "115cce6f792cc84e36da58960c5f1d760f32c12faef477e94c92eb75625b6a37"
                                      "1efc72d60ca5e908b3a7dd69fef0249150e3eebdfed39cbdc3ce9704882a2072"
                                      "c75e13527b7a581a556168783dc1e97545e31865ddc46b3c957835da252bb732"
                                      "8d3ee2062445dfb85ef8c35f8e1f3371af34023cef626e0af1e0bc017351aae2"
                                      "ab8f5c612ead0b729a1d059d02bfe18efa971b7300e882360a93b025ff97e9e0"
                                      "eec0f3f3f13039a17f88b0cf808f488431606cb13f9241f40f44e537d302c64a"
                                      "4f1f4ab949b9feefadcb71ab50ef27d6d6ca8510f150c85fb525bf25703df720"
                                      "9b6066f09c37280d59128d2f0f637c7d7d7fad4ed1c1ea04e628d221e3d8db77"
                                      "b7c878c9411cafc5071a34a00f4cf07738912753dfce48f07576f0d4f94f42c6"
                                      "d76f7ce973e9367095ba7e9a3649b7f461d9f9ac1332a4d1044c96aefee67676"
                                      "401b64457c54d65fef6500c59cdfb69af7b6dddfcb0f086278dd8ad0686078df"
                                      "b0f3f79cd893d314168648499898fbc0ced5f95b74e8ff14d735cdea968bee74"
                                      "00000005"
                                      "d8b8112f9200a5e50c4a262165bd342cd800b8496810bc716277435ac376728d"
                                      "129ac6eda839a6f357b5a04387c5ce97382a78f2a4372917eefcbf93f63bb591"
                                      "12f5dbe400bd49e4501e859f885bf0736e90a509b30a26bfac8c17b5991c157e"
                                      "b5971115aa39efd8d564a6b90282c3168af2d30ef89d51bf14654510a12b8a14"
                                      "4cca1848cf7da59cc2b3d9d0692dd2a20ba3863480e25b1b85ee860c62bf5136";

// Test case 2: seed, identifier and public key of both levels.
inline const char case2_upper_seed[] = "558b8966c48ae9cb898b423c83443aae014a72f1b1ab5cc85cf1d892903b5439";
inline const char case2_upper_key[] = "0000000600000003"
                                      "d08fabd4a2091ff0a8cb4ed834e74534"
                                      "32a58885cd9ba0431235466bff9651c6c92124404d45fa53cf161c28f1ad5a8e";
inline const char case2_lower_seed[] = "a1c4696e2608035a886100d05cd99945eb3370731884a8235e2fb3d4d71f2547";
inline const char case2_lower_key[] = "0000000500000004"
                                      "215f83b7ccb9acbcd08db97b0d04dc2b"
                                      "a1cd035833e0e90059603f26e07ad2aad152338e7a5e5984bcd5f7bb4eba40b7";

} // namespace rfc8554
