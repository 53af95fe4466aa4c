/* puck-tables 0.1.0: stop, state, resultants of flat pucks that slide and spin under dry friction.
JavaScript; error 1e-06 (see each function);
pressure annulus:0.8, k/r = 0.905539, 0 <= delta <= 1.64.
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

const STOP_QUANTUM = 1.8e-08;
const PATCH_QUANTUM = 9.2e-10;
const CONSTANTS_QUANTUM = 2e-09;
const TALLEST = 1.6400000000000001;
const STEEP = 0.7436049970255799;
const REACH = 16.0;
const END = 0.6284;
const SPIN_TIME = 0.9073780235273359;
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
2,0,30,0,.98,.04,2.5271238,2.3574644,0,2.3574644,43.757079,1,0,5,1.64,1,1,4.9126122,3.1898498,
-.44903763,3.2566479,11.681946,1,0,1,.82,1,1,1.5241969,.73553297,-.071307237,.74240064,.7851529,
.3,-.4,-.7,1.64,2.5,.6,.29932569,.051063079,-.046282724,.070205226,-.11468643,-1.5,.2,.02,.82,3,
.1,.50443045,-.3783095,.050513275,.38166697,.006963594,.01,.02,-6,1.64,1,.5,2.7233435,
.013825102,.040221906,.042908461,-8.1667354,1,1,0,.82,.5,2,2.8284271,1.4142136,1.4142136,2,0,0,
0,-3,.82,1,.25,.68053352,0,0,0,-1.0208003,1,0,1.5313894,0,1,1,1.8860737,1.0265131,0,1.0265131,
1.3624478,0,-1,2,0,1,1,2.2542449,0,-1.2949622,1.2949622,2.1057672,3e-7,4e-7,.08,1.64,9.81,1e-5,
1.0482683e-7,2.0750478e-14,1.968105e-14,2.9061067e-14,3.8775205e-9,200000,-100000,900,0,.1,300,
3674717.9,376360420000,-188180210000,420783740000,1618322200]);
const STATE_CASES = new Float64Array([
2,0,30,0,.98,.04,0,0,0,0,2,0,30,1,0,5,1.64,1,1,.4913,.47976479,-.0050800537,2.3252234,.95244406,
-.020732471,4.4657521,1,0,1,.82,1,1,.7621,.55892684,-.029588971,.58505244,.47629091,-.065345281,
.52246194,.3,-.4,-.7,1.64,2.5,.6,.2694,.050418727,-.046387148,-.11346196,.044400279,
-.0012502135,-.081827254,-1.5,.2,.02,.82,3,.1,.4994,-.37827198,.050507962,.0069548226,
-.01493383,.0020785519,.0025281481,.01,.02,-6,1.64,1,.5,0,0,0,0,.01,.02,-6,1,1,0,.82,.5,2,.2828,
.26866214,.26866214,0,.9000151,.9000151,0,0,0,-3,.82,1,.25,.3403,0,0,-.76565007,0,0,-1.4998535,
1,0,1.5313894,0,1,1,1.697,1.0151422,0,1.3498452,.12019106,0,.13340607,0,-1,2,0,1,1,2.232,0,
-1.2948047,2.1055929,8.6704735e-19,-.014159958,.015674312,3e-7,4e-7,.08,1.64,9.81,1e-5,0,0,0,0,
3e-7,4e-7,.08,200000,-100000,900,0,.1,300,367500,70153379000,-35076689000,312924020,181693.44,
-90846.722,803.3435,1,0,5,1.64,1,1,7.369,3.1898498,-.44903763,11.681946,-0,-0,0]);
const TURN_CASES = new Float64Array([
2,0,30,0,.98,.04,0,1,0,5,1.64,1,1,-2.2453668,1,0,1,.82,1,1,-1.3262362]);
const RESULTANTS_CASES = new Float64Array([
-.7853981633974483,0,1.0421913,0,1.3646787,-.7853981633974483,1.64,.99831104,.50909142,
1.1928267,-.3,0,1.0259005,0,.86716155,-.3,1.64,1.0255682,.43570934,.53622047,0,0,1,0,.82,0,1.64,
1,.41,.4838,.8,0,1.0196684,0,1.4180539,.8,1.64,.96936922,.49645517,1.2661125,1.4,0,.56641674,0,
1.8172043,1.4,1.64,.47184771,.21535945,1.8171517]);
const BORDERS = new Float64Array([
0,.111111111111]);
const ORIGINS = new Float64Array([
-1,.111111111111,1]);
const SCALES = new Float64Array([
1,-9,-1.125]);
const RATE_UNITS = new Float64Array([
.751,.744,3.42]);
const PATCH = new Float64Array([
9062764,3716486,3718041,9056335,3712862,3712377,9059193,3714441,3714797,9055993,3712680,3712108,
9066457,3718432,3720881,9118284,3747030,3764656,9233178,3811901,3866222,9410609,3917863,4040822,
9616875,4056001,4289732,9794288,4205464,4598020,9890231,4342602,4937950,9885580,4451093,5275902,
9801478,4526286,5579830,9682658,4572707,5825559,9572424,4598578,6001133,9495563,4611562,6108413,
9455425,4617172,6161039,9441489,4618965,6178885,9439803,4619180,6181039,9440360,4619108,6180326,
9439815,4619180,6181028,9441336,4618966,6179042,7847999,4670253,7663231,7531347,4653610,7863474,
7458601,4649379,7907057,7542017,4654355,7856970,7743405,4662809,7726938,8014191,4669604,7535735,
8306025,4671848,7309252,8582139,4669086,7074557,8820517,4662511,6854417,9012208,4653956,6664041,
9157506,4645121,6510505,9262072,4637195,6394153,9333767,4630788,6310953,9380585,4626053,6254789,
9409528,4622845,6219186,9426218,4620871,6198288,9434923,4619797,6187262,9438778,4619310,6182349,
9440020,4619152,6180762,9440169,4619133,6180572,9440119,4619139,6180635,9440169,4619133,6180572,
9440016,4619152,6180765,5039009,4095579,8188367,5029747,4091818,8184585,5034078,4093663,8186611,
5029139,4091543,8184252,5045518,4098587,8192114,5121279,4130883,8227628,5286077,4197964,8295414,
5549366,4295044,8373610,5894208,4402957,8418709,6281564,4498868,8394168,6662277,4568854,8298256,
6990817,4611866,8164616,7236771,4634785,8037967,7391749,4645633,7948283,7469090,4650117,7901169,
7495501,4651525,7884811,7498691,4651694,7882835,7497637,4651637,7883487,7498672,4651694,7882847,
7495756,4651528,7884656]);
const PATCH_ROWS = new Float64Array([
0,22,45,65]);
const STOP = new Float64Array([
9259260,4629630,-828199,4629630,6625590,1,0,-60744,0,485951,1,0,-4455,0,35642,0,0,-329,0,2632,0,
0,-24,0,193,9259259,4629630,-828199,4629630,6625590,0,0,-60744,0,485951,0,0,-4455,0,35642,0,0,
-329,0,2632,0,0,-24,0,193,9259259,4629630,-828199,4629630,6625590,0,0,-60744,0,485951,0,0,-4455,
0,35642,0,0,-329,0,2632,0,0,-24,0,193,9259259,4629630,-828199,4629630,6625590,0,0,-60744,0,
485951,1,0,-4455,0,35642,1,0,-329,0,2632,1,0,-24,0,193,9259273,4629630,-828199,4629630,6625590,
28,0,-60744,0,485951,26,0,-4455,0,35642,14,0,-329,0,2632,4,0,-24,0,193,9259381,4629629,-828200,
4629630,6625590,193,0,-60745,0,485952,137,0,-4456,0,35643,54,0,-329,0,2632,11,0,-24,0,193,
9259798,4629628,-828204,4629630,6625587,728,1,-60749,3,485957,427,0,-4459,1,35645,131,0,-331,0,
2631,18,0,-24,0,191,9260945,4629623,-828221,4629631,6625574,1992,3,-60763,14,485971,990,0,-4466,
4,35649,243,0,-332,1,2625,22,0,-24,0,187,9263485,4629609,-828267,4629635,6625531,4447,11,-60796,
46,485999,1900,1,-4480,12,35649,375,0,-334,3,2608,20,0,-23,1,177,9268332,4629573,-828371,
4629644,6625412,8613,30,-60860,124,486038,3191,2,-4501,31,35632,507,0,-333,7,2573,9,0,-21,1,161,
9276624,4629498,-828578,4629664,6625128,15015,71,-60970,290,486075,4851,5,-4526,71,35574,613,0,
-328,15,2507,-10,0,-17,2,136,9289660,4629353,-828947,4629701,6624522,24129,149,-61136,606,
486068,6818,10,-4549,143,35439,673,0,-315,28,2400,-34,0,-11,4,103,9308817,4629096,-829553,
4629767,6623343,36340,288,-61362,1164,485943,8995,19,-4559,266,35176,669,1,-292,48,2244,-58,0,
-4,5,65,9335442,4628671,-830483,4629876,6621206,51905,520,-61642,2083,485577,11253,33,-4542,458,
34730,595,1,-257,75,2034,-79,0,4,6,24,9370734,4628006,-831827,4630049,6617558,70925,888,-61953,
3514,484794,13452,55,-4479,737,34039,452,2,-209,107,1772,-94,0,11,7,-16,9415603,4627018,-833676,
4630314,6611637,93324,1446,-62256,5641,483360,15446,87,-4355,1121,33045,251,4,-151,143,1464,-99,
1,17,6,-50,9470529,4625620,-836107,4630712,6602442,118839,2263,-62496,8670,480982,17101,134,
-4155,1620,31702,7,6,-86,179,1125,-93,1,20,3,-75,9535414,4623738,-839171,4631305,6588711,147012,
3419,-62599,12823,477318,18305,197,-3869,2235,29979,-256,10,-19,208,773,-78,2,21,-2,-89,9609448,
4621333,-842882,4632190,6568928,177193,5009,-62474,18317,471991,18974,282,-3495,2954,27871,-516,
15,46,225,428,-55,2,19,-8,-91,9691005,4618443,-847199,4633519,6541365,208555,7134,-62026,25347,
464617,19061,390,-3036,3748,25403,-749,20,101,224,112,-27,2,14,-15,-83,9777609,4615228,-852009,
4635529,6504186,240117,9900,-61153,34051,454842,18562,522,-2508,4569,22631,-936,24,143,199,-155,
3,1,9,-21,-66,9865993,4612036,-857117,4638574,6455612,270799,13404,-59765,44475,442391,17516,
673,-1933,5356,19645,-1062,26,168,149,-358,31,0,2,-26,-45,9952289,4609458,-862233,4643162,
6394156,299485,17719,-57789,56545,427121,16003,834,-1341,6037,16559,-1119,23,175,77,-488,54,-2,
-3,-28,-23,10032370,4608362,-866972,4649967,6318906,325120,22877,-55186,70036,409074,14140,987,
-767,6537,13505,-1108,15,164,-11,-547,70,-3,-8,-26,-3,10102311,4609881,-870867,4659825,6229816,
346815,28845,-51961,84560,388513,12067,1109,-244,6793,10616,-1037,-1,139,-105,-542,78,-4,-10,
-20,12,10158909,4615330,-873396,4673654,6127935,363946,35510,-48175,99584,365938,9931,1173,195,
6762,8012,-920,-22,105,-192,-489,78,-4,-11,-12,21,10200156,4626017,-874040,4692323,6015522,
376243,42668,-43946,114471,342067,7873,1153,529,6437,5784,-775,-46,68,-260,-406,72,-3,-9,-2,23,
10225549,4642982,-872353,4716444,5895979,383823,50027,-39452,128545,317779,6006,1032,746,5848,
3980,-621,-68,33,-300,-311,62,-1,-7,7,22,10236155,4666671,-868070,4746125,5773624,387178,57232,
-34911,141179,294029,4411,807,850,5064,2606,-473,-84,5,-309,-221,49,1,-4,14,18,10234414,4696645,
-861203,4780726,5653343,387102,63906,-30566,151881,271756,3124,496,858,4176,1627,-345,-89,-14,
-289,-146,37,4,-2,17,13,10223736,4731360,-852145,4818687,5540209,384588,69705,-26648,160363,
251797,2146,134,797,3286,978,-241,-82,-24,-249,-91,27,5,0,17,8,10208001,4768138,-841710,4857480,
5439160,380703,74376,-23348,166576,234827,1448,-229,700,2486,579,-164,-67,-26,-201,-54,18,5,1,
16,5,10191060,4803322,-831130,4893726,5354785,376469,77808,-20789,170713,221327,981,-545,600,
1843,353,-111,-49,-24,-154,-33,13,5,1,13,3,10176311,4832702,-821924,4923550,5291170,372770,
80045,-19013,173155,211589,694,-780,518,1391,233,-79,-33,-21,-118,-22,9,4,1,10,2,10166386,
4852208,-815655,4943190,5251679,370280,81262,-17988,174372,205738,542,-918,469,1129,175,-61,-22,
-18,-97,-16,7,3,1,8,1,10162900,4859010,-813447,4950016,5238354,369407,81646,-17655,174736,
203791,494,-964,452,1044,158,-56,-19,-17,-90,-15,6,3,1,8,1,10166405,4852179,-815666,4943163,
5251683,370284,81265,-17987,174377,205737,542,-919,469,1129,175,-61,-22,-18,-97,-16,7,3,1,8,2,
10021355,5101635,-735249,5190345,4850177,335135,90874,-8651,180490,146564,-485,-2279,-16,-1340,
-60,53,91,12,120,4,-6,-6,-1,-11,0,10021472,5101462,-735303,5190175,4850407,335162,90869,-8656,
180489,146600,-485,-2278,-16,-1339,-60,53,91,12,120,4,-6,-6,-1,-11,0,10021400,5101568,-735270,
5190279,4850267,335145,90872,-8653,180489,146578,-485,-2279,-16,-1340,-60,53,91,12,120,4,-6,-6,
-1,-11,0,10021952,5100753,-735527,5189479,4851352,335273,90848,-8678,180483,146747,-483,-2275,
-15,-1333,-60,53,91,12,119,4,-6,-6,-1,-11,0,10024547,5096910,-736740,5185704,4856477,335874,
90736,-8796,180455,147541,-474,-2256,-9,-1299,-61,52,89,12,116,4,-6,-5,-1,-10,0,10030546,
5087930,-739577,5176881,4868529,337268,90474,-9073,180386,149401,-454,-2213,6,-1222,-61,49,86,
11,109,4,-5,-5,-1,-10,0,10040733,5072376,-744502,5161590,4889704,339650,90019,-9555,180260,
152639,-416,-2137,32,-1089,-60,46,79,9,97,4,-5,-5,-1,-9,0,10055074,5049866,-751659,5139439,
4921113,343033,89350,-10264,180043,157389,-357,-2028,69,-895,-56,39,69,7,80,4,-4,-4,-1,-7,0,
10072720,5021251,-760805,5111238,4962508,347241,88459,-11195,179688,163571,-274,-1887,119,-643,
-47,30,57,4,57,4,-3,-3,0,-5,0,10092206,4988514,-771337,5078908,5012123,351940,87363,-12314,
179146,170895,-165,-1720,178,-344,-30,18,43,0,30,3,-2,-2,0,-3,0,10111777,4954411,-782377,
5045141,5066665,356714,86108,-13557,178388,178866,-31,-1538,243,-15,-3,4,28,-4,1,0,0,0,0,0,0,
10129737,4921980,-792931,5012932,5121570,361139,84778,-14829,177446,186836,118,-1356,310,318,35,
-13,12,-9,-28,-3,1,1,0,2,0,10144718,4894042,-802046,4985091,5171544,364860,83500,-16012,176418,
194071,268,-1189,370,624,80,-30,-1,-12,-54,-7,3,2,1,5,1,10155814,4872809,-808969,4963860,
5211399,367631,82421,-16980,175467,199852,399,-1055,419,872,123,-45,-12,-15,-75,-11,5,2,1,6,1,
10162563,4859680,-813234,4950692,5236953,369322,81692,-17617,174783,203581,489,-969,451,1035,
155,-55,-18,-17,-89,-14,6,3,1,8,1,10164817,4855267,-814660,4946258,5245724,369887,81431,-17840,
174530,204870,521,-938,461,1092,167,-59,-21,-17,-94,-15,7,3,1,8,1,10162565,4859677,-813236,
4950691,5236931,369322,81694,-17616,174787,203576,488,-969,450,1034,155,-55,-18,-17,-89,-14,6,3,
1,8,1,8401648,5707410,-493528,5764801,4200824,0,116326,21308,167591,0,0,-5022,-920,-10652,0,0,
217,40,680,0,0,-9,-2,-43,0,8401648,5707410,-493528,5764801,4200824,0,116326,21308,167591,0,0,
-5022,-920,-10652,0,0,217,40,680,0,0,-9,-2,-43,0,8401648,5707410,-493528,5764801,4200824,0,
116326,21308,167591,0,0,-5022,-920,-10652,0,0,217,40,680,0,0,-9,-2,-43,0,8401648,5707410,
-493528,5764801,4200824,0,116326,21308,167591,0,0,-5022,-920,-10652,0,0,217,40,680,0,0,-9,-2,
-43,0,8401655,5707410,-493528,5764801,4200824,6,116326,21308,167591,0,2,-5022,-920,-10652,0,0,
217,40,680,0,0,-9,-2,-43,0,8401724,5707410,-493529,5764801,4200825,52,116326,21308,167591,0,13,
-5023,-920,-10651,0,1,217,40,680,0,0,-9,-2,-43,0,8402034,5707409,-493536,5764803,4200829,226,
116326,21306,167596,2,44,-5023,-920,-10650,0,1,217,40,681,0,0,-9,-2,-43,0,8402978,5707404,
-493563,5764810,4200845,686,116327,21298,167613,7,106,-5025,-921,-10647,0,0,217,40,681,0,-1,-9,
-2,-43,0,8405232,5707391,-493639,5764825,4200891,1657,116330,21277,167657,24,208,-5029,-923,
-10637,0,-4,216,40,681,0,-1,-9,-2,-43,0,8409798,5707355,-493813,5764854,4201002,3423,116340,
21230,167755,64,350,-5037,-925,-10619,0,-14,215,40,682,0,-1,-9,-2,-43,0,8417997,5707270,-494166,
5764892,4201237,6297,116361,21143,167941,150,523,-5050,-930,-10588,0,-29,214,40,683,0,0,-9,-2,
-43,0,8431423,5707084,-494806,5764917,4201686,10602,116400,20995,168257,313,712,-5070,-935,
-10539,1,-50,212,41,684,0,2,-9,-2,-43,0,8451859,5706701,-495873,5764867,4202484,16636,116462,
20765,168749,602,897,-5097,-941,-10468,1,-75,211,41,684,0,4,-9,-2,-43,0,8481151,5705960,-497533,
5764616,4203814,24659,116545,20431,169455,1085,1054,-5134,-946,-10372,3,-101,210,41,683,0,8,-8,
-2,-43,0,8521070,5704601,-499977,5763940,4205927,34865,116642,19974,170407,1848,1162,-5179,-950,
-10246,6,-125,210,42,681,0,11,-8,-2,-43,0,8573140,5702238,-503407,5762480,4209152,47372,116730,
19372,171614,3005,1203,-5231,-951,-10086,12,-144,211,42,679,0,15,-7,-2,-43,0,8638461,5698323,
-508032,5759712,4213911,62204,116773,18612,173064,4694,1166,-5287,-948,-9888,20,-154,215,42,675,
0,18,-7,-2,-43,0,8717519,5692131,-514051,5754921,4220738,79287,116716,17679,174716,7079,1050,
-5339,-940,-9644,30,-154,221,42,670,-1,20,-7,-2,-43,0,8810022,5682755,-521646,5747199,4230289,
98437,116493,16563,176498,10343,860,-5379,-927,-9348,44,-143,230,42,662,-2,20,-7,-2,-43,0,
8914766,5669146,-530965,5735477,4243351,119360,116027,15257,178314,14681,610,-5395,-908,-8989,
60,-121,240,42,652,-3,19,-7,-2,-44,0,9029579,5650186,-542108,5718605,4260834,141653,115240,
13759,180050,20280,322,-5374,-882,-8559,77,-91,250,42,637,-5,16,-9,-1,-44,0,9151374,5624822,
-555115,5695480,4283732,164817,114066,12070,181583,27302,22,-5303,-847,-8051,92,-55,259,42,617,
-8,12,-10,-1,-44,0,9276333,5592237,-569947,5665224,4313051,188282,112464,10198,182802,35847,
-264,-5171,-803,-7464,103,-18,265,42,589,-10,8,-12,-1,-43,1,9400224,5552049,-586473,5627386,
4349680,211436,110432,8159,183625,45929,-512,-4971,-747,-6799,108,17,266,42,553,-11,3,-13,-1,
-42,1,9518822,5504496,-604457,5582133,4394204,233675,108013,5981,184010,57437,-700,-4705,-680,
-6071,103,47,260,42,508,-12,-1,-14,-2,-41,1,9628356,5450557,-623543,5530377,4446674,254444,
105304,3704,183974,70121,-820,-4380,-601,-5299,89,68,247,41,455,-12,-5,-15,-2,-38,1,9725885,
5391989,-643254,5473819,4506346,273284,102445,1388,183586,83575,-869,-4012,-511,-4513,65,81,228,
39,396,-11,-7,-15,-2,-34,1,9809530,5331251,-662987,5414874,4571453,289851,99610,-894,182962,
97253,-857,-3624,-412,-3748,35,85,203,35,335,-8,-8,-14,-2,-30,1,9878498,5271344,-682017,5356516,
4639071,303929,96981,-3049,182244,110499,-799,-3245,-310,-3041,3,82,174,31,274,-5,-8,-12,-2,-25,
1,9932926,5215603,-699516,5302061,4705139,315416,94723,-4976,181572,122601,-715,-2903,-213,
-2429,-26,75,146,25,220,-2,-8,-10,-2,-20,1,9973591,5167479,-714569,5254946,4764691,324291,92957,
-6575,181046,132853,-626,-2623,-128,-1940,-47,67,122,20,175,1,-7,-8,-2,-16,0,10001564,5130281,
-726227,5218470,4812373,330580,91732,-7763,180707,140638,-549,-2422,-64,-1591,-57,59,104,16,143,
3,-6,-7,-1,-13,0,10017872,5106823,-733611,5195441,4843240,334327,91026,-8491,180528,145492,-497,
-2305,-25,-1385,-60,54,94,13,124,4,-6,-6,-1,-11,0,10023224,5098847,-736130,5187606,4853911,
335569,90793,-8736,180469,147141,-479,-2266,-12,-1316,-60,52,90,12,118,4,-6,-5,-1,-10,0,
10017882,5106831,-733607,5195451,4843200,334328,91026,-8491,180529,145488,-497,-2304,-25,-1385,
-60,54,94,13,124,4,-6,-6,-1,-11,0]);
const STOP_ROWS = new Float64Array([
0,37,54,89]);
const MOTION = new Float64Array([
6289312,48488,151,721,-64,-13,12,0,-2,0,0,0,6212823,-4188,-13,-62,5,1,-1,0,0,0,0,0,6211950,
-4792,-15,-71,6,1,-1,0,0,0,0,0,6291917,50294,156,747,-66,-14,12,0,-2,0,0,0,6457342,165137,477,
2608,-241,-46,44,0,-8,0,1,0,6711423,343748,765,5919,-576,-99,105,2,-19,0,3,0,7053990,588780,345,
11270,-1157,-177,208,8,-37,-1,6,0,7478853,898891,-2564,19236,-2099,-286,368,21,-65,-4,11,1,
7972068,1264966,-11501,29806,-3551,-438,596,44,-104,-8,17,1,8513313,1667529,-31614,41656,-5668,
-680,904,79,-154,-14,26,3,9080596,2079136,-67962,52231,-8514,-1066,1318,123,-219,-23,36,4,
9654802,2471975,-123170,59105,-11981,-1587,1878,174,-301,-33,48,6,10220544,2825165,-196132,
61301,-15871,-2155,2623,235,-402,-44,62,8,10763859,3127282,-282107,59383,-20050,-2677,3561,306,
-520,-57,77,10,11269852,3374869,-373674,54771,-24506,-3117,4657,385,-642,-71,89,12,11722561,
3569759,-462233,49016,-29262,-3483,5812,466,-750,-85,98,15,12107368,3716890,-539941,43368,
-34219,-3792,6877,542,-826,-96,102,16,12414743,3822930,-601604,38602,-39049,-4053,7705,606,-859,
-105,103,17,12643247,3895410,-645716,35025,-43276,-4261,8214,655,-860,-111,104,18,12800061,
3942025,-674123,32603,-46507,-4414,8433,687,-850,-115,107,18,12898722,3969992,-690599,31111,
-48630,-4514,8466,706,-846,-116,112,18,12955256,3985498,-699224,30275,-49818,-4572,8425,716,
-852,-117,116,19,12984547,3993361,-703306,29849,-50379,-4602,8380,722,-862,-118,119,19,12998146,
3996963,-705053,29653,-50602,-4616,8354,724,-870,-118,119,19,13003738,3998433,-705726,29574,
-50676,-4622,8345,725,-875,-118,119,19,13005744,3998958,-705957,29545,-50697,-4624,8343,725,
-877,-118,119,19,13006359,3999119,-706025,29536,-50702,-4625,8343,725,-878,-118,119,19,13006516,
3999160,-706042,29534,-50703,-4625,8343,725,-878,-118,119,19,13006549,3999169,-706046,29534,
-50703,-4625,8343,725,-878,-118,119,19,13006554,3999170,-706047,29534,-50703,-4625,8343,725,
-878,-118,119,19,13006554,3999170,-706047,29534,-50703,-4625,8343,725,-878,-118,119,19,13006555,
3999170,-706047,29534,-50703,-4625,8343,725,-878,-118,119,19,-196480,-1729,1308,-490,-178,10,27,
0,-211091,139,1156,39,-182,-1,28,0,-211487,187,1150,54,-182,-1,28,0,-195323,-1862,1325,-531,
-177,11,27,0,-163376,-6178,1553,-1681,-165,38,23,-1,-121087,-12394,1589,-3181,-142,82,19,-2,
-77616,-19337,1296,-4686,-107,136,13,-4,-41790,-25444,811,-5892,-65,188,8,-6,-18140,-29649,380,
-6671,-30,225,3,-7,-5968,-31861,129,-7066,-10,244,1,-8,-1355,-32707,29,-7215,-2,252,0,-9,-183,
-32922,4,-7253,0,254,0,-9,-11,-32953,0,-7259,0,254,0,-9,0,-32955,0,-7259,0,254,0,-9,0,-32955,0,
-7259,0,254,0,-9,0,-32955,0,-7259,0,254,0,-9,-1,-32955,0,-7259,0,254,0,-9,5605129,21975,-1872,
2060,-17,-237,5,24,-1,-2,0,0,5521307,-1880,161,-176,2,20,0,-2,0,0,0,0,5520184,-2204,186,-207,2,
24,-1,-2,0,0,0,0,5608463,22942,-1952,2151,-18,-247,6,25,-1,-3,0,0,5789536,73642,-7471,6720,-83,
-813,23,84,-5,-8,1,1,6061340,147687,-18891,12892,-220,-1685,59,176,-12,-18,2,2,6413071,240028,
-39888,19633,-357,-2841,131,305,-26,-31,5,3,6823991,342673,-73934,25736,-162,-4184,247,470,-51,
-48,9,5,7268162,445721,-121941,30355,931,-5535,378,659,-90,-69,16,7,7722818,539636,-181261,
33405,3333,-6717,452,846,-136,-93,26,9,8172279,617584,-247125,35394,6984,-7647,418,1007,-181,
-115,37,12,8604668,676560,-314389,36912,11443,-8333,283,1127,-218,-132,49,14,9006759,717102,
-378165,38290,16097,-8813,96,1206,-248,-143,60,15,9362411,742211,-434051,39566,20336,-9126,-84,
1251,-273,-149,70,16,9655911,756034,-478770,40627,23713,-9304,-217,1270,-296,-151,78,16,9877862,
762681,-511030,41377,26069,-9387,-297,1276,-315,-151,84,16,10029408,765415,-531816,41814,27519,
-9413,-339,1275,-327,-150,87,16,10121760,766354,-543724,42021,28321,-9415,-363,1273,-333,-150,
89,16,10171496,766616,-549777,42098,28727,-9411,-377,1272,-336,-150,90,16,10194917,766673,
-552496,42120,28914,-9409,-385,1272,-337,-150,91,16,10204428,766683,-553564,42125,28990,-9408,
-388,1272,-338,-150,91,16,10207695,766684,-553924,42126,29017,-9408,-390,1272,-338,-150,91,16,
10208619,766684,-554025,42126,29025,-9408,-390,1272,-338,-150,91,16,10208827,766684,-554047,
42126,29027,-9408,-390,1272,-338,-150,91,16,10208862,766684,-554051,42126,29027,-9408,-390,1272,
-338,-150,91,16,10208866,766684,-554052,42126,29027,-9408,-390,1272,-338,-150,91,16,10208866,
766684,-554052,42126,29027,-9408,-390,1272,-338,-150,91,16,10208867,766684,-554052,42126,29027,
-9408,-390,1272,-338,-150,91,16,367102,5175,2115,804,-283,-39,41,2,390936,-415,1770,-65,-280,3,
43,0,391568,-566,1759,-88,-280,4,43,0,365247,5617,2145,871,-283,-43,41,2,311953,17911,2759,2836,
-279,-132,36,5,238043,34374,3147,5631,-245,-243,27,8,157274,51485,2850,8785,-175,-341,17,9,
86711,65631,1929,11616,-97,-404,9,9,38167,74925,947,13594,-42,-434,4,8,12632,79682,328,14641,
-14,-446,1,7,2872,81480,75,15042,-3,-450,0,7,388,81936,10,15144,0,-451,0,7,24,82003,1,15159,0,
-451,0,7,0,82007,0,15160,0,-451,0,7,0,82008,0,15160,0,-451,0,7,0,82008,0,15160,0,-451,0,7,1,
82007,0,15160,0,-451,0,7]);
const MOTION_ROWS = new Float64Array([
0,384,520,856]);
const MOTION_CELLS = new Float64Array([
28,13,24,13]);
const MOTION_POWERS = new Float64Array([
6,4,6,4]);
const MOTION_QUANTA = new Float64Array([
6.7e-9,1e-8,6.7e-9,6.5e-9]);
const CONSTANTS = new Float64Array([
25200936,-140040,21319,-3245,512,-78,0,0,0,0,0,0,55555556,0,0,0,0,0,301250213,51249945,0,0,0,0,
271297636,21184475,-1962214,181754,-17056,1583,1341020579,203693222,0,0,0,0,0,0,0,0,0,0,
103339587,-9572244,886630,-82126,7707,-715,191122354,-52603,7964,-1206,189,-29]);
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
	for (let n = 0; n < 3 - 1; n++) side += c >= BORDERS[n] ? 1 : 0;
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
	look_up(STOP, STOP_ROWS[side] * 5 * 5, STOP_ROWS[side + 1] - STOP_ROWS[side] - 3, 3, 5, 5,
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
	for (let m = 6 - 1; m > -1; m--) total = total * s + CONSTANTS[row * 6 + m];
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
