/* puck-tables 0.1.0: stop, state, resultants of flat pucks that slide and spin under dry friction.
JavaScript; error 1e-06 (see each function);
pressure hertz, k/r = 0.632456, 0 <= delta <= 0.8.
Functions: stop, state, turn, resultants; self_test returns how many numbers of its vectors are
missed: 0.  Needs IEEE arithmetic (no -ffast-math).  Made by a program: do not edit.

MIT License

Copyright (c) 2026 The puck-tables authors

Permission is hereby granted, free of charge, to any person obtaining a copy
of this software and associated documentation files (the "Software"), to deal
in the Software without restriction, including without limitation the rights
to use, copy, modify, merge, publish, distribute, sublicense, and/or sell
copies of the Software, and to permit persons to whom the Software is
furnished to do so, subject to the following conditions:

The above copyright notice and this permission notice shall be included in all
copies or substantial portions of the Software.

THE SOFTWARE IS PROVIDED "AS IS", WITHOUT WARRANTY OF ANY KIND, EXPRESS OR
IMPLIED, INCLUDING BUT NOT LIMITED TO THE WARRANTIES OF MERCHANTABILITY,
FITNESS FOR A PARTICULAR PURPOSE AND NONINFRINGEMENT. IN NO EVENT SHALL THE
AUTHORS OR COPYRIGHT HOLDERS BE LIABLE FOR ANY CLAIM, DAMAGES OR OTHER
LIABILITY, WHETHER IN AN ACTION OF CONTRACT, TORT OR OTHERWISE, ARISING FROM,
OUT OF OR IN CONNECTION WITH THE SOFTWARE OR THE USE OR OTHER DEALINGS IN THE
SOFTWARE. */
(function () {
"use strict";

const STOP_QUANTUM = 2.8e-08;
const PATCH_QUANTUM = 2.9e-09;
const CONSTANTS_QUANTUM = 2e-09;
const TALLEST = 0.8000000000000002;
const STEEP = 3.1249999999999987;
const REACH = 16.0;
const END = 0.6264;
const SPIN_TIME = 0.6790620954271842;
const LONGEST = 4.0;
const TOLERANCE = 1e-06;
const LARGEST = 8e+307;
const SMALLEST = 1e-300;
const TURN_SHARE = 0.001;
const FARTHEST = 1000.0;
const CLOSE = 0.01;
const FAINT = 0.05;
const HALF_PI = 1.5707963267948966;
const STOP_CASES = new Float64Array([
2,0,30,0,.98,.04,2.3163174,2.1937982,0,2.1937982,42.097635,1,0,5,.8,1,1,3.6399205,1.9899365,
-.25136136,2.0217504,8.9462064,1,0,1,.4,1,1,1.2986721,.61032561,-.033526035,.61227459,.72059545,
.3,-.4,-.7,.8,2.5,.6,.25230534,.039581897,-.042899311,.058736141,-.10312095,-1.5,.2,.02,.4,3,.1,
.50442686,-.37831426,.050476403,.38166681,.006839664,.01,.02,-6,.8,1,.5,2.0374256,.008668423,
.024551631,.026239233,-6.1120201,1,1,0,.4,.5,2,2.8284271,1.4142136,1.4142136,2,0,0,0,-3,.4,1,
.25,.50929657,0,0,0,-.76394486,1,0,1.5313894,0,1,1,1.5325797,.75051814,0,.75051814,1.1974246,0,
-1,2,0,1,1,1.7768854,0,-.89538042,.89538042,1.7679892,3e-7,4e-7,.08,.8,9.81,1e-5,8.2194639e-8,
1.3977543e-14,1.4496715e-14,2.0293447e-14,3.3274397e-9,200000,-100000,900,0,.1,300,3082978,
295060270000,-147530130000,329887410000,1473278500]);
const STATE_CASES = new Float64Array([
2,0,30,0,.98,.04,0,0,0,0,2,0,30,1,0,5,.8,1,1,.364,.34954108,-.0040508884,1.7263741,.92013002,
-.022028152,4.4857557,1,0,1,.4,1,1,.6493,.46919505,-.013794439,.52173057,.45603512,-.03624193,
.58222603,.3,-.4,-.7,.8,2.5,.6,.2271,.039112194,-.042775809,-.10179998,.036589966,-.014637604,
-.10331434,-1.5,.2,.02,.4,3,.1,.4994,-.37827673,.050471261,.0068320321,-.01493853,.0020310196,
.0022399973,.01,.02,-6,.8,1,.5,0,0,0,0,.01,.02,-6,1,1,0,.4,.5,2,.2828,.26866214,.26866214,0,
.9000151,.9000151,0,0,0,-3,.4,1,.25,.2546,0,0,-.57288621,0,0,-1.5002844,1,0,1.5313894,0,1,1,
1.379,.74339296,0,1.1848008,.093388863,0,.1635549,0,-1,2,0,1,1,1.759,0,-.89528684,1.7678138,
6.4007509e-19,-.01045322,.019626155,3e-7,4e-7,.08,.8,9.81,1e-5,0,0,0,0,3e-7,4e-7,.08,200000,
-100000,900,0,.1,300,308300,58243520000,-29121760000,265875760,177901.26,-88950.631,824.29474,1,
0,5,.8,1,1,5.46,1.9899365,-.25136136,8.9462064,-0,-0,0]);
const TURN_CASES = new Float64Array([
2,0,30,0,.98,.04,0,1,0,5,.8,1,1,-1.633802,1,0,1,.4,1,1,-.87787827]);
const RESULTANTS_CASES = new Float64Array([
-.7853981633974483,0,1.2495608,0,.62478041,-.7853981633974483,.8,1.2411497,.3231025,.55749104,
-.3,0,1.0366298,0,.42163349,-.3,.8,1.0365751,.215512,.34099071,0,0,1,0,.4,0,.8,1,.2,.32,.8,0,
1.2550042,0,.64113324,.8,.8,1.2452492,.32699638,.57617582,1.4,0,1.186601,0,1.160325,1.4,.8,
1.0969804,.32301749,1.1601615]);
const BORDERS = new Float64Array([
0]);
const ORIGINS = new Float64Array([
-1,1]);
const SCALES = new Float64Array([
1,-1]);
const RATE_UNITS = new Float64Array([
.75,.3,.683]);
const PATCH = new Float64Array([
2875690,575171,575336,2872855,574561,574509,2874090,574825,574863,2872713,574530,574470,2877210,
575494,575754,2899572,580288,582159,2950326,591216,596971,3033346,609266,622247,3141847,633277,
657814,3259704,660115,700988,3368441,685950,747261,3455065,707776,791588,3515557,724208,829689,
3553129,735347,858955,3574112,742148,878777,3584611,745817,890292,3589120,747472,895711,3590554,
748009,897501,3590726,748074,897716,3590669,748052,897644,3590727,748074,897716,3590553,748009,
897503,3386496,846320,1691423,3384978,846335,1693034,3385598,846334,1692406,3384921,846334,
1693084,3387099,846335,1690910,3398260,846322,1679671,3423813,846049,1652482,3465455,844664,
1602527,3518601,840600,1525001,3572747,832285,1420964,3615830,819413,1300648,3640112,803596,
1181465,3645324,787581,1080161,3637229,773761,1005334,3623513,763292,956241,3610213,756187,
926911,3600366,751845,910704,3594480,749498,902508,3591698,748438,898932,3590780,748094,897783,
3590670,748053,897645,3590707,748066,897691,3590670,748053,897645,3590780,748094,897783]);
const PATCH_ROWS = new Float64Array([
0,22,46]);
const STOP = new Float64Array([
5952291,2976205,-513134,2976204,4105116,-11,0,-17694,-1,141556,24,0,-611,0,4888,8,0,-21,0,169,
5952412,2976185,-513137,2976185,4105082,4,0,-17695,0,141554,-8,0,-611,0,4887,-3,0,-21,0,168,
5952338,2976198,-513135,2976198,4105105,-7,0,-17694,-1,141555,11,0,-611,0,4887,4,0,-21,0,169,
5953478,2976095,-513151,2976100,4104924,757,2,-17699,8,141546,190,0,-612,1,4884,23,0,-21,0,167,
5956957,2975533,-513232,2975567,4103918,2756,16,-17714,55,141482,504,1,-613,6,4864,39,0,-21,1,
161,5963261,2974006,-513433,2974119,4101142,6169,54,-17741,184,141280,898,2,-611,20,4808,47,0,
-19,2,148,5972209,2970876,-513806,2971152,4095363,11001,133,-17771,446,140828,1312,5,-603,46,
4700,44,0,-16,4,128,5982961,2965404,-514396,2965960,4085081,17132,274,-17787,902,139989,1699,11,
-583,89,4526,32,1,-12,7,102,5994052,2956790,-515224,2957782,4068594,24348,503,-17766,1616,
138610,2020,21,-551,151,4279,13,1,-7,9,73,6003477,2944246,-516287,2945862,4044089,32358,847,
-17682,2649,136541,2249,35,-504,230,3958,-8,2,-2,12,44,6008843,2927095,-517546,2929551,4009814,
40819,1334,-17503,4049,133648,2372,54,-444,325,3571,-29,2,3,13,16,6007617,2904905,-518923,
2908422,3964307,49347,1990,-17202,5847,129837,2387,78,-371,428,3135,-47,3,7,13,-6,5997474,
2877625,-520297,2882417,3906676,57554,2834,-16755,8042,125076,2303,105,-292,531,2670,-60,2,10,
12,-22,5976692,2845708,-521503,2851950,3836882,65073,3871,-16149,10597,119416,2137,132,-210,623,
2202,-67,2,11,8,-32,5944529,2810162,-522345,2817970,3755946,71603,5088,-15383,13432,112995,1912,
156,-131,694,1758,-69,1,10,3,-35,5901478,2772497,-522614,2781911,3666021,76941,6453,-14473,
16431,106040,1655,174,-62,736,1358,-66,0,9,-2,-34,5849319,2734561,-522119,2745532,3570286,80998,
7911,-13455,19452,98840,1390,182,-5,746,1019,-60,-2,7,-7,-29,5790938,2698281,-520731,2710681,
3472674,83813,9390,-12379,22345,91720,1140,179,36,726,748,-52,-3,5,-11,-24,5729970,2665379,
-518435,2679016,3377496,85528,10810,-11307,24972,84999,919,165,62,682,542,-43,-4,3,-13,-18,
5670356,2637136,-515368,2651782,3289053,86365,12094,-10305,27229,78961,736,144,76,624,395,-36,
-5,1,-14,-14,5615914,2614264,-511840,2629684,3211302,86582,13180,-9431,29053,73825,593,119,81,
563,294,-29,-5,0,-14,-10,5570008,2596931,-508312,2612908,3147593,86439,14030,-8727,30427,69742,
489,95,81,507,228,-24,-5,0,-13,-8,5535325,2584927,-505310,2601271,3100492,86163,14632,-8219,
31371,66796,419,76,79,464,188,-21,-5,0,-13,-7,5513778,2577901,-503308,2594453,3071686,85928,
14988,-7913,31920,65023,379,64,77,437,167,-19,-4,0,-12,-6,5506473,2575588,-502607,2592207,
3062011,85838,15105,-7812,32099,64431,366,60,76,427,160,-18,-4,0,-12,-6,5513791,2577898,-503311,
2594450,3071690,85929,14988,-7913,31920,65023,379,64,77,437,167,-19,-4,0,-12,-6,4041972,2269295,
-362573,2287833,2020999,-11,23417,4790,41273,-1,-1,-309,-63,-972,0,0,4,1,23,0,4042060,2269308,
-362580,2287846,2021025,4,23417,4789,41274,0,0,-309,-63,-972,0,0,4,1,23,0,4042002,2269300,
-362575,2287838,2021008,-6,23417,4790,41274,-1,0,-309,-63,-972,0,0,4,1,23,0,4042475,2269370,
-362610,2287909,2021146,72,23419,4786,41277,9,6,-309,-63,-971,0,0,4,1,23,0,4045066,2269754,
-362802,2288302,2021907,487,23428,4764,41298,60,35,-310,-64,-969,0,2,4,1,23,0,4052055,2270801,
-363325,2289373,2023983,1564,23453,4706,41353,200,95,-310,-65,-962,0,2,4,1,23,0,4066118,2272943,
-364390,2291560,2028257,3605,23501,4589,41462,487,182,-311,-67,-948,0,1,4,1,23,0,4090015,
2276667,-366234,2295361,2035779,6817,23578,4394,41639,992,274,-313,-69,-927,0,-4,3,1,23,0,
4126237,2282474,-369089,2301278,2047736,11273,23682,4104,41886,1792,349,-316,-71,-896,-1,-11,3,
1,23,0,4176684,2290818,-373159,2309763,2065413,16900,23796,3712,42185,2968,387,-319,-70,-856,-2,
-18,3,1,22,0,4242367,2302041,-378590,2321148,2090115,23501,23894,3218,42498,4602,378,-323,-68,
-808,-4,-23,3,1,21,0,4323212,2316308,-385444,2335582,2123079,30790,23936,2630,42768,6766,327,
-326,-62,-751,-6,-25,3,1,20,0,4417967,2333561,-393689,2352983,2165344,38428,23876,1957,42926,
9516,243,-325,-54,-684,-10,-23,4,1,19,0,4524244,2353499,-403194,2373029,2217597,46071,23674,
1211,42904,12884,145,-319,-43,-605,-14,-19,4,1,17,0,4638711,2375602,-413732,2395176,2280023,
53399,23299,402,42651,16867,51,-304,-32,-515,-19,-13,4,1,15,0,4757409,2399181,-424994,2418719,
2352152,60149,22742,-459,42137,21419,-23,-279,-19,-414,-22,-7,4,1,12,0,4876146,2423468,-436617,
2442881,2432759,66131,22015,-1361,41365,26447,-66,-245,-5,-303,-22,-2,4,0,9,0,4990910,2447692,
-448201,2466893,2519819,71236,21151,-2291,40366,31814,-75,-204,8,-187,-19,0,3,0,6,0,5098212,
2471156,-459342,2490066,2610549,75429,20198,-3229,39196,37345,-52,-158,22,-70,-9,1,2,0,2,0,
5195315,2493272,-469662,2511832,2701553,78741,19211,-4153,37926,42836,-2,-111,35,42,7,-1,0,0,-1,
0,5280320,2513565,-478833,2531738,2789061,81250,18244,-5033,36631,48075,65,-67,47,144,29,-3,-1,
-1,-4,-1,5352126,2531649,-486608,2549425,2869263,83066,17346,-5839,35387,52856,139,-27,57,233,
56,-7,-2,-1,-7,-2,5410296,2547182,-492840,2564580,2938699,84311,16557,-6540,34261,56995,213,5,
65,306,87,-10,-3,-1,-9,-3,5454886,2559826,-497497,2576890,2994629,85111,15910,-7111,33312,60345,
279,31,71,362,116,-14,-4,-1,-11,-4,5486244,2569227,-500654,2586030,3035273,85581,15429,-7532,
32592,62800,330,49,74,402,141,-16,-4,0,-11,-5,5504814,2575044,-502454,2591679,3059788,85820,
15133,-7788,32142,64294,363,59,76,425,158,-18,-4,0,-12,-6,5510956,2577017,-503034,2593594,
3067960,85891,15033,-7874,31988,64796,374,63,77,433,164,-18,-4,0,-12,-6,5504820,2575039,-502457,
2591675,3059792,85821,15133,-7788,32142,64294,362,59,76,425,158,-18,-4,0,-12,-6]);
const STOP_ROWS = new Float64Array([
0,26,54]);
const MOTION = new Float64Array([
5262233,26579,25,325,-41,1,4,0,0,0,5203708,-2280,-2,-28,4,0,0,0,0,0,5202953,-2654,-3,-32,4,0,0,
0,0,0,5264500,27695,26,338,-43,1,4,0,0,0,5391459,89892,-46,1122,-147,2,14,0,-1,0,5585403,183308,
-547,2345,-321,1,29,0,-3,0,5846102,304761,-2082,3963,-585,-4,51,1,-4,0,6171123,447999,-5550,
5807,-961,-17,82,2,-7,0,6555364,604044,-12034,7577,-1480,-42,122,4,-10,0,6990350,762581,-22518,
8938,-2169,-80,175,7,-14,-1,7463122,913869,-37493,9661,-3050,-129,243,10,-19,-1,7955043,1050246,
-56585,9715,-4132,-184,328,15,-24,-2,8441595,1166799,-78361,9247,-5394,-242,424,20,-29,-2,
8894535,1261304,-100500,8495,-6775,-298,521,26,-33,-2,9287004,1333828,-120445,7691,-8155,-351,
604,31,-36,-3,9600172,1386232,-136276,6994,-9389,-396,662,34,-37,-3,9828196,1421625,-147324,
6476,-10350,-430,691,37,-37,-3,9978577,1443768,-154118,6135,-10993,-453,700,39,-37,-3,10067818,
1456469,-157824,5936,-11358,-467,699,40,-38,-3,10115131,1463068,-159629,5832,-11534,-475,697,40,
-38,-3,10137327,1466131,-160417,5783,-11606,-478,697,40,-39,-3,10146418,1467379,-160722,5763,
-11631,-480,697,41,-39,-3,10149610,1467816,-160826,5756,-11639,-480,697,41,-39,-3,10150546,
1467945,-160856,5754,-11641,-481,697,41,-39,-3,10150768,1467975,-160863,5754,-11642,-481,697,41,
-39,-3,10150809,1467981,-160865,5754,-11642,-481,697,41,-39,-3,10150815,1467981,-160865,5754,
-11642,-481,697,41,-39,-3,10150815,1467981,-160865,5754,-11642,-481,697,41,-39,-3,10150816,
1467981,-160865,5754,-11642,-481,697,41,-39,-3,-1732570,6637,72298,-759,-9963,40,1422,-5,-216,1,
32,0,-1785165,-567,76172,65,-10651,-3,1535,0,-235,0,36,0,-1785841,-667,76219,76,-10659,-4,1536,
1,-235,0,36,0,-1730612,6942,72171,-793,-9943,42,1419,-5,-215,1,32,0,-1618863,21177,64109,-2473,
-8536,115,1191,-14,-177,2,26,0,-1456835,39393,53067,-4765,-6689,182,905,-19,-131,2,19,0,
-1259809,58233,41097,-7415,-4841,214,641,-17,-93,1,14,0,-1048538,74911,30216,-10212,-3337,206,
447,-9,-68,0,11,0,-842237,87999,21443,-13010,-2268,175,323,1,-54,-2,9,1,-654218,97322,14859,
-15696,-1562,137,245,12,-45,-4,8,1,-491559,103436,10108,-18169,-1106,101,195,21,-38,-5,7,1,
-356696,107146,6751,-20348,-806,72,159,29,-33,-6,6,1,-249125,109220,4409,-22183,-598,50,129,35,
-28,-6,5,1,-166629,110279,2798,-23653,-444,34,102,39,-22,-6,4,1,-106035,110762,1711,-24769,-323,
23,78,42,-17,-6,3,1,-63683,110952,997,-25569,-226,16,57,43,-13,-6,2,1,-35754,111012,547,-26105,
-149,11,38,44,-9,-6,2,1,-18558,111023,279,-26438,-92,8,24,44,-5,-6,1,1,-8791,111021,130,-26629,
-51,6,14,44,-3,-6,1,1,-3744,111017,55,-26727,-26,5,7,44,-2,-6,0,1,-1408,111015,20,-26773,-11,4,
3,44,-1,-6,0,1,-458,111014,6,-26792,-4,4,1,44,0,-6,0,1,-125,111014,2,-26798,-1,4,0,44,0,-6,0,1,
-28,111014,0,-26800,0,4,0,44,0,-6,0,1,-5,111014,0,-26801,0,4,0,44,0,-6,0,1,-1,111014,0,-26801,0,
4,0,44,0,-6,0,1,0,111014,0,-26801,0,4,0,44,0,-6,0,1,0,111014,0,-26801,0,4,0,44,0,-6,0,1,0,
111014,0,-26801,0,4,0,44,0,-6,0,1,2350022,9288,39553,2011,-5648,-62,836,-2,-124,1,2320727,-764,
39718,-165,-5538,5,821,0,-122,0,2320106,-984,39720,-213,-5536,7,820,0,-122,0,2351872,9945,39547,
2155,-5655,-66,837,-2,-124,1,2415789,30917,39129,6686,-5903,-205,873,-8,-129,2,2506434,57977,
38440,12520,-6280,-381,926,-15,-136,4,2612955,85001,37665,18367,-6762,-543,994,-23,-145,6,
2720965,106141,37239,23011,-7301,-644,1068,-29,-155,7,2816360,118836,37506,25871,-7819,-679,
1136,-32,-164,8,2889424,124520,38329,27186,-8236,-680,1188,-32,-171,8,2937318,126351,39228,
27617,-8512,-677,1223,-31,-176,8,2963638,126753,39849,27712,-8663,-676,1243,-31,-178,8,2975397,
126809,40155,27725,-8730,-676,1252,-31,-179,8,2979484,126814,40264,27726,-8753,-676,1255,-31,
-180,8,2980521,126814,40292,27726,-8759,-676,1255,-31,-180,8,2980696,126814,40297,27726,-8760,
-676,1256,-31,-180,8,2980712,126814,40297,27726,-8760,-676,1256,-31,-180,8,2980713,126814,40297,
27726,-8760,-676,1256,-31,-180,8,2980713,126814,40297,27726,-8760,-676,1256,-31,-180,8,2980714,
126814,40297,27726,-8760,-676,1256,-31,-180,8,1848629,2164,31779,663,-4400,-10,650,-2,-97,0,
1859206,-186,31763,-57,-4441,1,658,0,-98,0,1859336,-215,31763,-66,-4441,1,658,0,-98,0,1848239,
2252,31780,690,-4398,-10,650,-2,-97,0,1824960,7354,31815,2260,-4309,-33,632,-6,-94,1,1788345,
15181,31864,4684,-4167,-66,604,-12,-89,2,1737030,25751,31917,7991,-3967,-107,564,-21,-83,4,
1669447,38987,31956,12195,-3703,-154,513,-32,-74,6,1583888,54674,31944,17282,-3366,-200,447,-46,
-64,9,1478654,72414,31813,23203,-2949,-236,368,-64,-51,12,1352365,91573,31449,29855,-2448,-251,
276,-84,-36,15,1204530,111240,30672,37063,-1866,-230,174,-109,-20,18,1036476,130222,29230,44558,
-1222,-157,67,-135,-4,22,852652,147151,26827,51967,-564,-20,-32,-163,12,25,661948,160755,23250,
58829,27,178,-110,-189,24,27,477952,170291,18579,64681,448,415,-152,-210,30,28,316490,175919,
13377,69204,630,650,-155,-223,30,29,190117,178639,8541,72346,594,843,-130,-228,26,29,102882,
179704,4810,74314,440,975,-92,-229,18,29,49900,180049,2389,75433,271,1055,-56,-228,11,28,21551,
180145,1046,76008,143,1097,-30,-227,6,28,8201,180171,401,76274,65,1116,-14,-226,3,28,2707,
180178,133,76383,25,1124,-5,-226,1,27,758,180180,38,76421,8,1127,-2,-225,0,27,175,180181,9,
76433,2,1128,0,-225,0,27,32,180181,2,76435,0,1128,0,-225,0,27,4,180181,0,76436,0,1128,0,-225,0,
27,0,180181,0,76436,0,1128,0,-225,0,27,0,180181,0,76436,0,1128,0,-225,0,27,-1,180181,0,76436,0,
1128,0,-225,0,27]);
const MOTION_ROWS = new Float64Array([
0,290,638,838]);
const MOTION_CELLS = new Float64Array([
25,25,16,26]);
const MOTION_POWERS = new Float64Array([
5,6,5,5]);
const MOTION_QUANTA = new Float64Array([
8e-9,6.7e-9,6.4e-9,8e-9]);
const CONSTANTS = new Float64Array([
143193280,-6099591,852218,-122687,18113,-2849,440,0,0,0,0,0,0,0,321596640,-3049796,426109,
-61343,9056,-1424,220,275000333,24999963,0,0,0,0,0,116627164,15936551,-662472,27538,-1145,48,-2,
271925879,44482446,0,0,0,0,0,0,0,0,0,0,0,0,112912620,-4693702,195114,-8111,337,-14,1,126346255,
-1019148,124110,-15520,1988,-269,36]);
/* What a launch is, and the code of a refusal.

m: 0 slip speed Q, 1 v/Q, 2 r|w|/Q, 3 vx/Q, 4 vy/Q, 5 whether r|w| > v, 6 2 min(v, r|w|)/(v +
r|w|), 7 the sign of w. */
function measured(vx, vy, spin, delta, decel, radius, m) {
	let none = vx - vx + (vy - vy) + (spin - spin) + (decel - decel) + (radius - radius);
	if (!(none == 0.0 && delta >= 0.0 && delta <= TALLEST && decel > 0.0 && radius > 0.0)) {
		return 1;
	}
	let edge = radius * spin;
	if (edge - edge != 0.0) return 2;
	let x = vx;
	let y = vy;
	let e = edge;
	let large = Math.abs(vx) + Math.abs(vy) + Math.abs(edge);
	if (large > 1e-100 && large < 1e+100) {
		large = 1.0;
	} else {
		large = Math.abs(vx) > Math.abs(vy) ? Math.abs(vx) : Math.abs(vy);
		large = Math.abs(edge) > large ? Math.abs(edge) : large;
		if (large == 0.0) {
			for (let n = 0; n < 7; n++) m[n] = 0.0;
			m[7] = 1.0;
			return 0;
		}
		x = vx / large;
		y = vy / large;
		e = edge / large;
	}
	let speed2 = x * x + y * y;
	let speed = Math.sqrt(speed2);
	let rim = Math.abs(e);
	let q = Math.sqrt(speed2 + e * e);
	let unit = 1.0 / q;
	m[0] = large * q;
	m[1] = speed * unit;
	m[2] = rim * unit;
	m[3] = x * unit;
	m[4] = y * unit;
	m[5] = rim > speed ? 1.0 : 0.0;
	m[6] = 2.0 * (rim < speed ? rim : speed) / (speed + rim);
	m[7] = edge < 0.0 ? -1.0 : 1.0;
	let size = LONGEST * (m[0] / decel) * m[0];
	return size < LARGEST && size < LARGEST * radius ? 0 : 2;
}
/* Between which marks a place lies. */
function side_of(c) {
	let side = 0;
	for (let n = 0; n < 2 - 1; n++) side += c >= BORDERS[n] ? 1 : 0;
	return side;
}
/* The functions of a table, from its number first on, at a place and at a height s. */
const look_up_w = new Float64Array(8);
const look_up_row = new Float64Array(70);
function look_up(table, first, cells, degree, powers, functions, quantum, xi, s, out_row) {
	const w = look_up_w;
	let p = xi * cells;
	let cell = Math.floor(p);
	cell = cell > cells - 1 ? cells - 1 : cell;
	let t = p - cell;
	w[0] = quantum;
	for (let d = 1; d < degree + 1; d++) {
		let saved = 0.0;
		for (let r = 0; r < d; r++) {
			let part = w[r];
			w[r] = saved + (r + 1 - t) * part;
			saved = (t + (d - 1 - r)) * part;
		}
		w[d] = saved;
	}
	let width = powers * functions;
	let here = first + cell * width;
	const row = look_up_row;
	for (let j = 0; j < width; j++) row[j] = w[0] * table[here + j];
	for (let n = 1; n < degree + 1; n++) {
		for (let j = 0; j < width; j++) row[j] += w[n] * table[here + n * width + j];
	}
	for (let f = 0; f < functions; f++) {
		let value = row[width - functions + f];
		for (let k = powers - 2; k > -1; k--) value = value * s + row[k * functions + f];
		out_row[f] = value;
	}
}
/* The place xi between the marks of a side: 0 at its origin, 1 at the next. */
function place_of(side, c) {
	let q = (c - ORIGINS[side]) * SCALES[side];
	q = Math.sqrt(q > 0.0 ? q : 0.0);
	return 1.0 - Math.sqrt(q < 1.0 ? 1.0 - q : 0.0);
}
/* T, along, across, path length and body angle by look-up. */
function stop_table_at(c, delta, f) {
	let side = side_of(c);
	look_up(STOP, STOP_ROWS[side] * 4 * 5, STOP_ROWS[side + 1] - STOP_ROWS[side] - 3, 3, 4, 5,
			STOP_QUANTUM, place_of(side, c), STEEP * delta * delta - 1.0, f);
}
/* The functions of a stop: by look-up, in pure sliding and in pure spin exactly. */
function stop_functions(side, share, delta, f) {
	stop_table_at(side == 1 ? 1.0 - share : share - 1.0, delta, f);
	if (share == 0.0 && side == 0) {
		f[0] = 1.0;
		f[1] = 0.5;
		f[3] = 0.5;
	} else if (share == 0.0) {
		f[0] = SPIN_TIME;
		f[4] = 0.5 * SPIN_TIME;
	}
}
/* Stop time, place, path length and body angle of a measured launch. */
function stopped(m, f, delta, decel, radius, out) {
	let duration = m[0] / decel;
	let size = duration * m[0];
	let across = delta * m[7] * m[2] * f[2];
	out[0] = duration * f[0];
	out[1] = size * (f[1] * m[3] - across * m[4]);
	out[2] = size * (f[1] * m[4] + across * m[3]);
	out[3] = size * m[1] * f[3];
	out[4] = size / radius * m[7] * m[2] * f[4];
}
/* The code of a refusal; all results are not a number. */
function refused(out, size, code) {
	for (let n = 0; n < size; n++) out[n] = NaN;
	return code;
}
/* Stop time s, place x m, y m, path length m and body angle rad of a launch, into out[5].

vx, vy m/s; spin rad/s, counter-clockwise positive; delta = 2 f h / r from 0 to TALLEST;
decel = f g m/s^2; radius m.  Errors: the tolerance times Q/J, Q^2/J, Q^2/J and Q^2/(J r), where
Q = hypot(v, r w) and J is decel.  Returns 0; 1 where a number is not finite or out of range, 2
where the motion is too large for floating point: nothing but NaN is in out then. */
const stop_m = new Float64Array(8);
const stop_f = new Float64Array(5);
function stop(vx, vy, spin, delta, decel, radius, out) {
	const m = stop_m;
	const f = stop_f;
	let code = measured(vx, vy, spin, delta, decel, radius, m);
	if (code != 0) return refused(out, 5, code);
	stop_functions(Math.floor(m[5]), m[6], delta, f);
	stopped(m, f, delta, decel, radius, out);
	return 0;
}
/* One of the numbers that depend on the height alone. */
function constant(row, s) {
	let total = 0.0;
	for (let m = 7 - 1; m > -1; m--) total = total * s + CONSTANTS[row * 7 + m];
	return CONSTANTS_QUANTUM * total;
}
/* C less its limit, on pieces 0 and 2 share exp(z); and the regular part of the heading. */
function limit_motion_at(branch, z, s, out_row) {
	let part = z / REACH;
	let xi = 0.5 * (Math.sqrt(part * (part + 4.0)) - part) / END;
	let powers = MOTION_POWERS[branch];
	look_up(MOTION, MOTION_ROWS[branch], MOTION_CELLS[branch], 4, powers > 1 ? powers : 1, 2,
			MOTION_QUANTA[branch], xi < 1.0 ? xi : 1.0, s, out_row);
}
/* By how much z, the way from theta = 0, falls short, nearly: what is there falls like exp(-z).

Pieces 0 and 2 hold share exp(z) in its stead. */
function falls_short(branch, z, s, wanted, f) {
	limit_motion_at(branch, z, s, f);
	let there = branch == 1 ? -f[0] : f[0];
	if (!(there > 0.0)) return -1.0;
	return Math.log(there / wanted) - (branch == 0 || branch == 2 ? z : 0.0);
}
/* The heading on an orbit that comes from, or to, an end. */
function heading_at(end, theta, rate, delta, s, part) {
	let regular = part * RATE_UNITS[end] / rate;
	return delta / TALLEST * (constant(6 + end, s) * theta + regular);
}
/* Where on its orbit a measured launch is that both slides and spins; ``time``: its T. */
const know_f = new Float64Array(2);
function know(delta, time, launch) {
	const f = know_f;
	let s = STEEP * delta * delta - 1.0;
	let c = launch[5] == 1.0 ? 1.0 - launch[6] : launch[6] - 1.0;
	let limit = constant(0, s);
	let fast = c > limit ? 1 : 0;
	let start = constant(1 + fast, s);
	let ahead = (fast == 1 ? c < start : c > start) ? 1 : 0;
	let wanted = Math.abs(c - limit);
	let first = Math.abs(start - limit);
	let least = FAINT * TOLERANCE;
	if (ahead == 0) {
		wanted = launch[5] == fast ? launch[6] : 2.0 - launch[6];
		first = fast == 1 ? 1.0 - start : 1.0 + start;
		least = SMALLEST;
	}
	wanted = wanted > least ? wanted : least;
	let close = CLOSE * TOLERANCE / (ahead == 1 ? wanted : 1.0);
	let branch = 2 * fast + ahead;
	let low = 0.0;
	let high = ahead == 1 ? REACH * END * END / (1.0 - END) : FARTHEST;
	let before = first > wanted ? Math.log(first / wanted) : 0.0;
	let z = before < high ? before : high;
	let error = falls_short(branch, z, s, wanted, f);
	let slope = z > 0.0 ? (error - before) / z : -1.0;
	let n = 0;
	while (n < 40 && Math.abs(error) > close) {
		low = error > 0.0 ? z : low;
		high = error > 0.0 ? high : z;
		slope = slope < 0.0 ? slope : -1.0;
		let last = z;
		before = error;
		z = z - error / slope;
		z = z >= low && z <= high ? z : 0.5 * (low + high);
		error = falls_short(branch, z, s, wanted, f);
		slope = z != last ? (error - before) / (z - last) : -1.0;
		n = n + 1;
	}
	let end = ahead == 1 ? 2 : fast;
	let rate = constant(3 + end, s);
	let theta = ahead == 1 ? -z / rate : z / rate;
	launch[8] = fast;
	launch[9] = theta;
	launch[10] = heading_at(end, theta, rate, delta, s, f[1]);
	launch[11] = time;
}
/* The place on the orbit and the functions of a stop there, from the time that is left. */
const arrive_o = new Float64Array(2);
function arrive(launch, delta, log_left, place, f) {
	const o = arrive_o;
	let s = STEEP * delta * delta - 1.0;
	let theta = launch[9] + log_left;
	let fast = Math.floor(launch[8]);
	let ahead = theta < 0.0 ? 1 : 0;
	let end = ahead == 1 ? 2 : fast;
	let rate = constant(3 + end, s);
	let z = Math.abs(theta) * rate;
	limit_motion_at(2 * fast + ahead, z, s, o);
	let c = constant(0, s) + o[0];
	let share = 1.0 - Math.abs(c);
	let side = c > 0.0 ? 1 : 0;
	if (ahead == 0) {
		share = o[0] * Math.exp(-z);
		side = share <= 1.0 ? fast : 1 - fast;
		share = share <= 1.0 ? share : 2.0 - share;
	}
	if (share < 0.0) share = 0.0;
	place[0] = side;
	place[1] = share;
	place[2] = heading_at(end, theta, rate, delta, s, o[1]);
	stop_functions(side, share, delta, f);
}
/* How far the heading turns until Q has fallen to 1/1000, rad, into out[1].

For delta > 0 it turns on without end.  The launch is that of stop(), the error the tolerance in
rad, the code as there. */
const turn_launch = new Float64Array(12);
const turn_g = new Float64Array(5);
const turn_place = new Float64Array(3);
function turn(vx, vy, spin, delta, decel, radius, out) {
	const launch = turn_launch;
	const g = turn_g;
	const place = turn_place;
	let code = measured(vx, vy, spin, delta, decel, radius, launch);
	if (code != 0) return refused(out, 1, code);
	out[0] = 0.0;
	if (launch[1] == 0.0 || launch[2] == 0.0 || delta == 0.0) return 0;
	stop_functions(Math.floor(launch[5]), launch[6], delta, g);
	know(delta, g[0], launch);
	let left = TURN_SHARE;
	for (let unused = 0; unused < 12; unused++) {
		arrive(launch, delta, Math.log(left), place, g);
		left = TURN_SHARE * g[0] / launch[11];
	}
	out[0] = launch[7] * (place[2] - launch[10]);
	return 0;
}
/* Place x m, y m, body angle rad, velocity vx, vy m/s and spin rad/s at a time, into out[6].

The launch is that of stop(); time s >= 0 after it, at rest from the stop on.  Errors: the
tolerance times Q^2/J (place), Q^2/(J r) (angle), Q (velocity) and Q/r (spin) of the launch.
Returns 0, 1 or 2 as stop() does. */
const state_launch = new Float64Array(12);
const state_f = new Float64Array(5);
const state_g = new Float64Array(5);
const state_end = new Float64Array(5);
const state_place = new Float64Array(3);
function state(vx, vy, spin, delta, decel, radius, time, out) {
	const launch = state_launch;
	const f = state_f;
	const g = state_g;
	const end = state_end;
	const place = state_place;
	let code = measured(vx, vy, spin, delta, decel, radius, launch);
	if (!(time - time == 0.0 && time >= 0.0)) code = 1;
	if (code != 0) return refused(out, 6, code);
	stop_functions(Math.floor(launch[5]), launch[6], delta, f);
	stopped(launch, f, delta, decel, radius, end);
	let left = time < end[0] ? 1.0 - time / end[0] : 0.0;
	if (left == 0.0 || launch[1] == 0.0 || launch[2] == 0.0 || time == 0.0) {
		let done = (1.0 - left) * (1.0 + left);
		out[0] = end[1] * done;
		out[1] = end[2] * done;
		out[2] = end[4] * done;
		out[3] = left * vx;
		out[4] = left * vy;
		out[5] = left * spin;
		return 0;
	}
	let slip = launch[0];
	let around = launch[7];
	let size = slip / decel * slip;
	know(delta, f[0], launch);
	arrive(launch, delta, Math.log1p(-(time / end[0])), place, g);
	let fall = left * launch[11] / g[0];
	let small = 0.5 * place[1];
	let large = 1.0 - small;
	let unit = fall / Math.sqrt(small * small + large * large);
	let now = unit * (place[0] == 1.0 ? small : large);
	let turn = unit * (place[0] == 1.0 ? large : small);
	let heading = around * (place[2] - launch[10]);
	let cosine = Math.cos(heading);
	let sine = Math.sin(heading);
	let east = (cosine * launch[3] - sine * launch[4]) / launch[1];
	let north = (cosine * launch[4] + sine * launch[3]) / launch[1];
	let ahead = size * fall * now * g[1];
	let aside = size * around * delta * turn * now * g[2];
	out[0] = end[1] - (ahead * east - aside * north);
	out[1] = end[2] - (ahead * north + aside * east);
	out[2] = end[4] - size / radius * around * fall * turn * g[4];
	out[3] = slip * now * east;
	out[4] = slip * now * north;
	out[5] = slip / radius * around * turn;
	return 0;
}
/* p_a, p_b and p_d, closer at lines of the friction than stops are. */
function shape_integrals(ratio, fast, p) {
	let c = (1.0 - ratio) / (1.0 + ratio);
	c = fast ? c : -c;
	let side = side_of(c);
	look_up(PATCH, PATCH_ROWS[side] * 3, PATCH_ROWS[side + 1] - PATCH_ROWS[side] - 5, 5, 1, 3,
			PATCH_QUANTUM, 1.0 - Math.sqrt(1.0 - place_of(side, c)), 0.0, p);
}
/* rho_parallel, rho_perpendicular and rho_omega, into out[3].

phi = atan2(r w, v) from -pi/2 to pi/2, delta = 2 f h / r from 0 to TALLEST.  Force on the puck
-f N cos(phi) rho_parallel along its velocity and -f N sin(phi) cos(phi) rho_perpendicular to
its left, torque -(f N r / 2) sin(phi) rho_omega.  Returns 0, or 1 and NaN where an argument is
not in its range. */
const resultants_p = new Float64Array(3);
function resultants(phi, delta, out) {
	const p = resultants_p;
	if (!(Math.abs(phi) <= HALF_PI && delta >= 0.0 && delta <= TALLEST)) return refused(out, 3, 1);
	let cosine = Math.abs(Math.cos(phi));
	let sine = Math.abs(Math.sin(phi));
	let fast = sine > cosine;
	shape_integrals(fast ? cosine / sine : sine / cosine, fast, p);
	let cos2 = cosine * cosine;
	let sin2 = sine * sine;
	let share = delta / TALLEST;
	let d2 = share * share;
	let parallel = p[0] / (1.0 - d2 * sin2 * p[1] * (p[1] - p[2]));
	out[0] = parallel;
	out[1] = share * parallel * p[1];
	out[2] = 2.0 * (p[2] + d2 * cos2 * parallel * p[1] * (p[2] - 2.0 * p[1]));
	return 0;
}
/* 1 where a number is off by more than the tolerance, in units of its scale; else 0. */
function misses(got, wanted, unit) {
	return Math.abs(got - wanted) <= TOLERANCE * unit + 1e-300 ? 0 : 1;
}
/* How many numbers of the test vectors resultants() misses. */
const resultants_misses_out = new Float64Array(3);
function resultants_misses() {
	let c = RESULTANTS_CASES;
	const out = resultants_misses_out;
	let missed = 0;
	for (let n = 0; n < 10; n++) {
		let k = n * 5;
		missed += resultants(c[k], c[k + 1], out);
		for (let j = 0; j < 3; j++) missed += misses(out[j], c[k + 2 + j], 1.0);
	}
	return missed;
}
/* How many numbers of the test vectors turn() misses. */
const turn_misses_out = new Float64Array(1);
function turn_misses() {
	let c = TURN_CASES;
	const out = turn_misses_out;
	let missed = 0;
	for (let n = 0; n < 3; n++) {
		let k = n * 7;
		missed += turn(c[k], c[k + 1], c[k + 2], c[k + 3], c[k + 4], c[k + 5], out);
		for (let j = 0; j < 1; j++) missed += misses(out[j], c[k + 6 + j], 1.0);
	}
	return missed;
}
/* The scale of a stop time, a place, a path length or a body angle.

From c[k] on the case has vx, vy, w, delta, J, r. */
function stop_unit(c, k, j) {
	let edge = c[k + 5] * c[k + 2];
	let slip = Math.sqrt(c[k] * c[k] + c[k + 1] * c[k + 1] + edge * edge);
	let unit = slip / c[k + 4] * (j == 0 ? 1.0 : slip);
	return j == 4 ? unit / c[k + 5] : unit;
}
/* How many numbers of the test vectors stop() misses. */
const stop_misses_out = new Float64Array(5);
function stop_misses() {
	let c = STOP_CASES;
	const out = stop_misses_out;
	let missed = 0;
	for (let n = 0; n < 12; n++) {
		let k = n * 11;
		missed += stop(c[k], c[k + 1], c[k + 2], c[k + 3], c[k + 4], c[k + 5], out);
		for (let j = 0; j < 5; j++) missed += misses(out[j], c[k + 6 + j], stop_unit(c, k, j));
	}
	return missed;
}
/* The scale of a place, an angle, a velocity or a spin. */
function state_unit(c, k, j) {
	let unit = j < 3 ? stop_unit(c, k, 1) : stop_unit(c, k, 0) * c[k + 4];
	return j == 2 || j == 5 ? unit / c[k + 5] : unit;
}
/* How many numbers of the test vectors state() misses. */
const state_misses_out = new Float64Array(6);
function state_misses() {
	let c = STATE_CASES;
	const out = state_misses_out;
	let missed = 0;
	for (let n = 0; n < 13; n++) {
		let k = n * 13;
		missed += state(c[k], c[k + 1], c[k + 2], c[k + 3], c[k + 4], c[k + 5], c[k + 6], out);
		for (let j = 0; j < 6; j++) missed += misses(out[j], c[k + 7 + j], state_unit(c, k, j));
	}
	return missed;
}
/* How many numbers of the test vectors are missed: 0. */
function self_test() {
	return stop_misses() + state_misses() + turn_misses() + resultants_misses();
}
globalThis.puckTables = { stop, state, turn, resultants, self_test };
if (typeof module === "object") module.exports = { stop, state, turn, resultants, self_test };
})();
