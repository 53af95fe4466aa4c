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
5952381,2976190,-513136,2976190,4105091,0,0,-17694,0,141555,0,0,-611,0,4887,0,0,-21,0,169,
5952381,2976190,-513136,2976190,4105091,0,0,-17694,0,141555,0,0,-611,0,4887,0,0,-21,0,169,
5952381,2976190,-513136,2976190,4105091,0,0,-17694,0,141555,0,0,-611,0,4887,0,0,-21,0,169,
5952381,2976190,-513136,2976190,4105091,0,0,-17694,0,141555,0,0,-611,0,4887,0,0,-21,0,169,
5952383,2976190,-513136,2976190,4105091,3,0,-17694,0,141555,1,0,-611,0,4887,0,0,-21,0,169,
5952405,2976189,-513137,2976189,4105090,22,0,-17694,0,141555,9,0,-611,0,4887,2,0,-21,0,169,
5952499,2976183,-513138,2976183,4105078,94,0,-17695,1,141554,31,0,-611,0,4887,6,0,-21,0,168,
5952770,2976159,-513141,2976160,4105036,283,1,-17696,3,141552,79,0,-611,0,4886,11,0,-21,0,168,
5953390,2976088,-513152,2976094,4104911,678,2,-17698,9,141545,163,0,-612,1,4884,19,0,-21,0,167,
5954583,2975918,-513177,2975933,4104608,1392,7,-17704,23,141526,290,0,-612,3,4878,28,0,-21,0,
165,5956614,2975559,-513227,2975592,4103961,2547,15,-17713,53,141483,463,1,-613,6,4865,37,0,-21,
1,162,5959743,2974870,-513319,2974939,4102714,4266,33,-17726,111,141395,681,1,-612,12,4840,43,0,
-20,1,155,5964178,2973652,-513474,2973784,4100488,6661,63,-17744,213,141228,934,2,-610,23,4796,
46,0,-19,2,146,5970015,2971631,-513716,2971868,4096756,9822,114,-17763,383,140937,1211,5,-605,
40,4726,45,0,-17,3,133,5977168,2968449,-514071,2968850,4090812,13805,196,-17779,649,140458,1495,
8,-594,66,4622,39,0,-14,5,116,5985297,2963662,-514565,2964306,4081754,18626,321,-17783,1047,
139711,1767,13,-577,102,4476,28,1,-11,7,96,5993745,2956740,-515221,2957734,4068472,24252,505,
-17763,1620,138599,2008,21,-551,151,4280,14,1,-7,9,74,6001487,2947094,-516049,2948569,4049665,
30594,769,-17702,2414,137012,2202,32,-515,213,4030,-3,2,-3,11,50,6007123,2934111,-517044,
2936225,4023892,37507,1134,-17580,3477,134835,2332,47,-468,287,3726,-21,2,1,13,27,6008916,
2917228,-518179,2920157,3989680,44784,1624,-17375,4849,131958,2388,65,-411,372,3372,-37,2,5,14,
6,6004930,2896025,-519396,2899960,3945687,52171,2262,-17062,6562,128293,2366,87,-345,463,2978,
-52,3,8,13,-12,5993248,2870353,-520597,2875477,3890930,59378,3067,-16622,8625,123792,2269,111,
-272,553,2559,-62,2,10,11,-25,5972279,2840447,-521649,2846923,3825044,66106,4048,-16039,11017,
118471,2105,136,-198,634,2133,-68,2,11,7,-32,5941106,2807018,-522381,2814962,3748531,72076,5200,
-15309,13682,112418,1891,158,-125,698,1723,-69,1,10,3,-35,5899795,2771266,-522599,2780731,
3662925,77073,6500,-14440,16529,105807,1646,174,-60,736,1347,-66,0,9,-2,-33,5849574,2734792,
-522114,2745754,3570824,80966,7903,-13461,19433,98882,1392,182,-6,746,1022,-60,-2,7,-7,-29,
5792815,2699400,-520783,2711757,3475743,83735,9344,-12413,22256,91942,1148,179,35,727,756,-52,
-3,5,-11,-24,5732810,2666829,-518558,2680413,3381826,85467,10746,-11356,24857,85301,929,166,61,
685,550,-44,-4,3,-13,-18,5673392,2638492,-515544,2653091,3293469,86338,12031,-10355,27121,79258,
745,145,76,628,401,-36,-5,1,-14,-14,5618495,2615286,-512025,2630672,3214928,86582,13130,-9471,
28971,74061,600,120,81,566,298,-29,-5,1,-14,-10,5571748,2597553,-508457,2613510,3149975,86450,
13999,-8753,30378,69892,493,96,81,509,231,-24,-5,0,-13,-8,5536163,2585204,-505387,2601540,
3101617,86172,14618,-8231,31350,66865,420,77,79,465,189,-21,-5,0,-13,-7,5513943,2577952,-503324,
2594503,3071904,85930,14985,-7916,31916,65036,379,64,77,437,167,-19,-4,0,-12,-6,5506390,2575562,
-502599,2592182,3061902,85836,15106,-7811,32101,64425,366,60,76,427,160,-18,-4,0,-12,-6,5513958,
2577950,-503327,2594501,3071910,85931,14985,-7916,31916,65036,379,64,77,437,167,-19,-4,0,-12,-6,
4042036,2269305,-362578,2287843,2021018,0,23417,4790,41274,0,0,-309,-63,-972,0,0,4,1,23,0,
4042036,2269305,-362578,2287843,2021018,0,23417,4790,41274,0,0,-309,-63,-972,0,0,4,1,23,0,
4042036,2269305,-362578,2287843,2021018,0,23417,4790,41274,0,0,-309,-63,-972,0,0,4,1,23,0,
4042036,2269305,-362578,2287843,2021018,0,23417,4790,41274,0,0,-309,-63,-972,0,0,4,1,23,0,
4042037,2269305,-362578,2287843,2021018,0,23417,4790,41274,0,0,-309,-63,-972,0,0,4,1,23,0,
4042041,2269306,-362578,2287844,2021019,1,23417,4789,41274,0,0,-309,-63,-972,0,0,4,1,23,0,
4042067,2269309,-362580,2287847,2021027,5,23417,4789,41274,1,0,-309,-63,-972,0,0,4,1,23,0,
4042166,2269324,-362587,2287862,2021056,21,23418,4788,41275,3,2,-309,-63,-972,0,0,4,1,23,0,
4042457,2269367,-362609,2287906,2021141,68,23419,4786,41277,8,5,-309,-63,-971,0,0,4,1,23,0,
4043165,2269472,-362661,2288014,2021349,182,23421,4780,41283,22,13,-309,-63,-971,0,1,4,1,23,0,
4044671,2269696,-362773,2288243,2021792,422,23427,4768,41295,52,29,-310,-64,-969,0,1,4,1,23,0,
4047557,2270127,-362988,2288683,2022646,872,23437,4744,41318,110,57,-310,-64,-966,0,2,4,1,23,0,
4052650,2270893,-363370,2289467,2024168,1645,23455,4701,41358,212,97,-310,-65,-961,0,2,4,1,23,0,
4061047,2272170,-364006,2290771,2026715,2871,23484,4632,41423,384,151,-311,-66,-953,0,1,4,1,23,
0,4074106,2274184,-365005,2292827,2030759,4689,23527,4524,41522,655,214,-312,-68,-941,0,-1,4,1,
23,0,4093411,2277214,-366503,2295919,2036908,7227,23588,4367,41662,1068,280,-313,-69,-924,0,-5,
3,1,23,0,4120676,2281585,-368652,2300372,2045913,10584,23665,4149,41847,1670,337,-315,-70,-901,
-1,-10,3,1,23,0,4157614,2287649,-371615,2306542,2058669,14804,23755,3859,42075,2520,375,-318,
-71,-871,-1,-15,3,1,22,0,4205751,2295758,-375553,2314776,2076208,19873,23844,3492,42330,3683,
386,-321,-69,-835,-3,-20,3,1,22,0,4266213,2306220,-380600,2325379,2099661,25702,23912,3044,
42586,5230,365,-324,-66,-791,-4,-24,3,1,21,0,4339510,2319256,-386854,2338557,2130202,32135,
23930,2514,42801,7230,313,-326,-61,-739,-7,-25,3,1,20,0,4425339,2334942,-394348,2354373,2168946,
38961,23863,1905,42925,9748,236,-325,-53,-678,-11,-23,4,1,19,0,4522462,2353176,-403040,2372703,
2216827,45928,23675,1223,42901,12834,147,-319,-44,-607,-14,-19,4,1,17,0,4628685,2373653,-412803,
2393225,2274426,52774,23335,473,42678,16511,59,-305,-33,-523,-18,-13,4,1,15,0,4740968,2395885,
-423419,2415432,2341800,59250,22827,-338,42220,20768,-14,-283,-21,-428,-21,-8,4,1,13,0,4855677,
2419235,-434591,2438676,2418300,65145,22151,-1202,41514,25549,-61,-252,-8,-323,-22,-3,4,0,10,0,
4968929,2442993,-445957,2462241,2502437,70305,21328,-2108,40575,30747,-76,-213,5,-210,-20,0,3,0,
7,0,5076977,2466441,-457114,2485416,2591826,74642,20398,-3037,39446,36209,-59,-168,19,-94,-12,1,
2,0,3,0,5176550,2488917,-467652,2507552,2683232,78138,19411,-3968,38188,41735,-14,-121,32,20,3,
0,1,0,-1,0,5265086,2509844,-477183,2528093,2772763,80830,18425,-4869,36878,47102,51,-75,45,125,
24,-3,-1,0,-4,-1,5340830,2528726,-485388,2546570,2856204,82802,17493,-5707,35594,52078,126,-34,
55,219,51,-6,-2,-1,-7,-2,5402794,2545115,-492045,2562565,2929482,84165,16663,-6447,34414,56445,
203,1,64,296,82,-10,-3,-1,-9,-3,5450626,2558576,-497061,2575674,2989167,85042,15974,-7055,33407,
60017,272,28,70,357,113,-13,-4,-1,-10,-4,5484416,2568661,-500475,2585479,3032869,85557,15458,
-7506,32636,62654,327,48,74,399,140,-16,-4,0,-11,-5,5504480,2574936,-502423,2591574,3059343,
85816,15138,-7783,32150,64267,362,59,76,425,158,-18,-4,0,-12,-5,5511123,2577071,-503050,2593647,
3068183,85893,15030,-7877,31984,64809,374,63,77,433,164,-18,-4,0,-12,-6,5504486,2574930,-502426,
2591569,3059346,85817,15138,-7783,32151,64267,362,59,76,425,158,-18,-4,0,-12,-5]);
const STOP_ROWS = new Float64Array([
0,35,72]);
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
/* The root of the share of a side that lies between its origin and a place, from 0 to 1. */
function root_of(side, c) {
	let share = (c - ORIGINS[side]) * SCALES[side];
	share = share > 0.0 ? share : 0.0;
	return Math.sqrt(share < 1.0 ? share : 1.0);
}
/* T, along, across, path length and body angle by look-up. */
function stop_table_at(c, delta, f) {
	let side = side_of(c);
	let xi = 1.0 - Math.sqrt(1.0 - Math.sqrt(root_of(side, c)));
	look_up(STOP, STOP_ROWS[side] * 4 * 5, STOP_ROWS[side + 1] - STOP_ROWS[side] - 3, 3, 4, 5,
			STOP_QUANTUM, xi, STEEP * delta * delta - 1.0, f);
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
			PATCH_QUANTUM, 1.0 - Math.sqrt(Math.sqrt(1.0 - root_of(side, c))), 0.0, p);
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
