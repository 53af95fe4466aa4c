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

const STOP_QUANTUM = 2.2e-08;
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
7575656,3787880,-677612,3787878,5420940,124,-1,-49696,-3,397592,236,0,-3644,-1,29163,110,0,-270,
0,2157,14,0,-21,0,159,7575794,3787878,-677619,3787879,5420936,-44,0,-49701,1,397597,-86,0,-3646,
0,29161,-44,0,-269,0,2152,-8,0,-19,0,158,7575706,3787879,-677615,3787879,5420939,58,0,-49698,-2,
397595,123,0,-3645,0,29162,72,0,-270,0,2155,16,0,-20,0,159,7578093,3787870,-677648,3787881,
5420917,2714,5,-49726,19,397626,1295,0,-3661,5,29172,290,0,-273,1,2143,20,0,-20,0,149,7585353,
3787817,-677804,3787895,5420743,8921,33,-49824,135,397688,3186,2,-3692,34,29147,469,0,-272,8,
2089,1,0,-16,1,124,7599268,3787673,-678182,3787932,5420165,18954,111,-50006,451,397708,5474,7,
-3723,108,29018,557,0,-260,22,1974,-26,0,-9,3,87,7621035,3787378,-678877,3788008,5418802,32704,
271,-50261,1092,397556,7869,18,-3732,249,28713,542,1,-233,44,1797,-53,0,-1,5,44,7651298,3786863,
-679971,3788140,5416131,49829,553,-50561,2203,397049,10144,35,-3698,475,28172,438,1,-192,74,
1563,-72,0,6,6,2,7690187,3786059,-681524,3788352,5411497,69843,1002,-50859,3932,395972,12132,61,
-3606,798,27350,266,3,-141,107,1287,-81,0,13,5,-32,7737337,3784905,-683572,3788673,5404110,
92168,1669,-51099,6426,394088,13720,99,-3445,1221,26226,54,5,-83,140,986,-78,1,16,3,-58,7791912,
3783359,-686118,3789149,5393076,116161,2607,-51216,9819,391155,14843,151,-3212,1735,24797,-172,
8,-25,167,682,-67,1,17,-1,-72,7852631,3781418,-689136,3789843,5377420,141144,3874,-51146,14225,
386939,15472,219,-2910,2323,23086,-391,11,30,183,392,-48,2,16,-6,-75,7917807,3779132,-692559,
3790856,5356143,166416,5524,-50827,19720,381237,15613,304,-2549,2958,21130,-584,15,76,184,132,
-26,2,13,-11,-69,7985416,3776634,-696285,3792329,5328292,191279,7608,-50203,26335,373889,15299,
404,-2142,3603,18987,-738,19,111,168,-86,-2,1,8,-16,-57,8053200,3774152,-700170,3794466,5293043,
215060,10167,-49231,34046,364799,14587,518,-1707,4218,16724,-846,21,133,134,-253,20,0,3,-20,-41,
8118802,3772030,-704036,3797532,5249796,237141,13226,-47880,42763,353953,13547,637,-1264,4758,
14419,-904,20,142,85,-368,38,-1,-1,-22,-25,8179931,3770726,-707670,3801863,5198275,256990,16789,
-46141,52328,341426,12264,754,-833,5184,12147,-916,16,139,24,-431,52,-2,-5,-22,-9,8234540,
3770801,-710833,3807853,5138605,274189,20831,-44023,62522,327391,10826,855,-433,5461,9984,-885,
7,126,-43,-450,61,-3,-7,-19,3,8280995,3772880,-713273,3815925,5071365,288458,25294,-41560,73069,
312115,9319,928,-81,5566,7993,-820,-6,105,-109,-432,64,-4,-8,-14,12,8318211,3777591,-714743,
3826490,4997600,299676,30088,-38808,83659,295946,7822,959,211,5492,6221,-732,-22,81,-167,-388,
63,-3,-8,-8,17,8345737,3785491,-715021,3839888,4918781,307882,35089,-35843,93968,279290,6403,
938,435,5245,4701,-630,-38,55,-213,-329,59,-3,-8,-1,19,8363762,3796970,-713934,3856320,4836733,
313263,40147,-32758,103681,262586,5112,858,588,4849,3445,-525,-54,31,-241,-265,52,-1,-6,5,18,
8373066,3812163,-711389,3875776,4753524,316138,45096,-29660,112524,246277,3982,719,675,4340,
2447,-422,-65,10,-252,-202,43,1,-4,10,16,8374905,3830877,-707398,3897976,4671345,316921,49767,
-26658,120283,230780,3032,529,704,3760,1685,-330,-71,-5,-245,-147,35,2,-2,13,12,8370867,3852539,
-702100,3922332,4592401,316085,54007,-23854,126820,216466,2260,303,687,3158,1130,-251,-71,-15,
-226,-103,27,4,-1,14,9,8362711,3876193,-695774,3947929,4518813,314129,57688,-21341,132082,
203643,1658,59,639,2576,744,-186,-65,-20,-197,-69,21,4,0,14,6,8352225,3900522,-688842,3973549,
4452568,311538,60726,-19187,136105,192551,1205,-179,575,2053,487,-136,-55,-21,-165,-46,15,4,1,
13,4,8341093,3923926,-681852,3997727,4395479,308759,63091,-17438,138998,183356,879,-392,508,
1616,325,-100,-43,-20,-134,-30,11,4,1,11,3,8330800,3944645,-675440,4018850,4349176,306179,64804,
-16108,140934,176165,656,-565,450,1278,226,-74,-32,-18,-108,-21,8,3,1,9,2,8322561,3960937,
-670268,4035320,4315065,304112,65931,-15188,142116,171027,513,-688,406,1044,169,-58,-23,-16,-89,
-16,7,3,1,7,1,8317267,3971325,-666920,4045769,4294221,302785,66562,-14653,142738,167951,434,
-760,380,907,140,-49,-17,-14,-78,-13,6,3,1,7,1,8315445,3974881,-665767,4049339,4287231,302328,
66764,-14477,142931,166928,409,-784,372,863,131,-46,-16,-14,-74,-12,5,2,1,6,1,8317273,3971317,
-666923,4045761,4294220,302786,66562,-14652,142739,167951,434,-760,380,907,140,-49,-17,-14,-78,
-13,6,3,1,7,1,8203142,4168480,-603326,4241163,3975694,275088,74186,-7250,147632,121070,-385,
-1837,-4,-1048,-50,42,72,10,94,3,-4,-4,-1,-8,0,8197476,4176711,-600734,4249244,3964829,273783,
74430,-6996,147693,119370,-403,-1878,-18,-1120,-49,44,76,10,100,3,-5,-5,-1,-9,0,8203124,4168446,
-603339,4241127,3975776,275087,74186,-7251,147632,121077,-384,-1837,-4,-1048,-50,42,72,10,94,3,
-4,-4,-1,-8,0,8216493,4148140,-609764,4221169,4003273,278207,73596,-7878,147473,125292,-336,
-1739,29,-874,-49,37,64,7,78,4,-4,-4,-1,-7,0,8234163,4120087,-618697,4193553,4042838,282391,
72753,-8768,147183,131248,-261,-1603,76,-632,-43,29,52,4,56,3,-3,-3,0,-5,0,8253242,4088415,
-628864,4162299,4090023,286975,71723,-9830,146710,138239,-160,-1444,133,-346,-30,18,38,1,31,2,
-2,-2,0,-3,0,8271519,4056748,-639106,4130958,4140212,291426,70577,-10971,146040,145584,-40,
-1276,193,-44,-6,4,24,-3,4,1,0,-1,0,0,0,8287484,4027976,-648467,4102388,4188762,295357,69405,
-12095,145216,152633,92,-1115,251,250,27,-10,11,-7,-22,-2,1,1,0,2,0,8300246,4004178,-656232,
4078674,4231321,298527,68317,-13102,144342,158794,219,-973,303,511,65,-25,-1,-10,-45,-6,3,1,0,4,
1,8309399,3986656,-661945,4061152,4264232,300813,67425,-13902,143555,163568,327,-862,343,716,
101,-37,-10,-12,-62,-9,4,2,1,5,1,8314852,3976048,-665391,4050512,4284888,302179,66835,-14417,
143001,166582,400,-792,369,847,127,-45,-15,-14,-73,-12,5,2,1,6,1,8316654,3972519,-666531,
4046966,4291900,302631,66627,-14595,142799,167613,426,-768,377,893,137,-48,-17,-14,-77,-13,5,2,
1,6,1,8314855,3976041,-665394,4050507,4284880,302180,66837,-14416,143004,166579,400,-792,369,
847,127,-45,-15,-14,-73,-12,5,2,1,6,1,6873842,4669700,-403785,4716652,3437033,-31,95175,17438,
137113,-2,27,-4109,-752,-8716,0,4,178,33,557,0,-1,-8,-1,-35,0,6874159,4669699,-403799,4716657,
3437040,12,95176,17433,137122,1,-9,-4109,-753,-8714,0,-2,178,33,557,0,0,-8,-1,-35,0,6873962,
4669700,-403791,4716654,3437035,-18,95176,17436,137116,-1,12,-4109,-753,-8716,0,2,178,33,557,0,
0,-8,-1,-35,0,6876424,4669689,-403859,4716672,3437075,1176,95177,17415,137160,13,167,-4114,-755,
-8706,0,-2,177,33,558,0,-1,-8,-1,-35,0,6885062,4669619,-404201,4716725,3437293,4412,95197,17325,
137349,92,401,-4128,-760,-8672,0,-20,175,33,559,0,0,-8,-1,-35,0,6902835,4669376,-405049,4716763,
3437887,10087,95249,17129,137769,308,644,-4154,-767,-8607,1,-48,173,33,559,0,2,-7,-1,-36,0,
6931943,4668743,-406638,4716612,3439115,18327,95337,16799,138473,754,842,-4192,-773,-8509,2,-78,
171,34,559,0,6,-7,-2,-36,0,6973756,4667368,-409179,4715951,3441291,29074,95442,16320,139473,
1540,961,-4240,-777,-8376,5,-104,171,34,557,0,10,-6,-2,-35,0,7028815,4664748,-412854,4714289,
3444795,42147,95527,15683,140742,2796,987,-4294,-778,-8209,11,-122,174,35,555,0,13,-6,-2,-35,0,
7096824,4660230,-417805,4710969,3450076,57274,95538,14888,142220,4662,920,-4347,-773,-8002,20,
-128,178,35,550,0,16,-5,-2,-35,0,7176679,4653036,-424136,4705197,3457658,74111,95411,13935,
143822,7282,774,-4390,-764,-7751,31,-122,185,35,545,-1,16,-5,-1,-35,0,7266516,4642322,-431903,
4696097,3468133,92260,95079,12830,145443,10799,567,-4413,-749,-7451,45,-106,193,34,536,-2,16,-6,
-1,-36,0,7363814,4627260,-441118,4682799,3482146,111281,94479,11578,146975,15336,324,-4405,-727,
-7097,59,-81,202,34,525,-4,14,-7,-1,-36,0,7465563,4607142,-451742,4664547,3500363,130708,93566,
10189,148317,20982,71,-4355,-700,-6683,73,-52,210,34,509,-6,11,-8,-1,-36,0,7568482,4581502,
-463685,4640820,3523416,150072,92317,8673,149383,27775,-170,-4257,-665,-6212,83,-21,216,35,487,
-8,7,-9,-1,-36,1,7669292,4550223,-476801,4611446,3551815,168919,90741,7048,150120,35688,-378,
-4107,-622,-5686,88,8,218,35,459,-9,3,-11,-1,-35,1,7764986,4513619,-490886,4576688,3585848,
186837,88879,5336,150506,44613,-540,-3907,-571,-5116,86,33,215,34,425,-10,0,-12,-1,-34,1,
7853068,4472470,-505677,4537281,3625453,203480,86802,3565,150560,54356,-648,-3663,-511,-4517,76,
52,206,34,385,-10,-3,-12,-2,-32,1,7931721,4427997,-520853,4494411,3670107,218576,84610,1773,
150336,64641,-703,-3386,-443,-3908,60,64,192,32,341,-9,-5,-12,-2,-29,1,7999867,4381794,-536036,
4449647,3718716,231941,82414,6,149913,75118,-710,-3092,-370,-3312,39,69,174,30,294,-8,-6,-12,-2,
-26,1,8057127,4335726,-550794,4404839,3769575,243472,80334,-1681,149386,85385,-679,-2799,-293,
-2753,14,69,154,27,247,-5,-7,-11,-2,-22,1,8103696,4291813,-564650,4361997,3820371,253131,78477,
-3230,148852,95009,-624,-2524,-217,-2253,-9,65,132,23,204,-3,-7,-9,-2,-18,1,8140169,4252122,
-577083,4323185,3868283,260934,76930,-4581,148387,103560,-558,-2285,-147,-1830,-28,59,112,19,
166,0,-6,-8,-1,-15,0,8167345,4218671,-587549,4290418,3910173,266923,75743,-5678,148040,110644,
-493,-2095,-89,-1499,-41,53,95,15,135,2,-6,-6,-1,-12,0,8186047,4193306,-595506,4265539,3942894,
271150,74925,-6483,147819,115937,-440,-1961,-45,-1265,-48,48,83,12,113,3,-5,-5,-1,-10,0,8196968,
4177518,-600477,4250038,3963712,273662,74453,-6971,147699,119202,-405,-1882,-19,-1126,-49,44,76,
11,101,3,-5,-5,-1,-9,0,8200556,4172180,-602162,4244794,3970848,274495,74297,-7136,147659,120306,
-393,-1856,-10,-1080,-49,43,74,10,97,3,-5,-5,-1,-9,0,8196974,4177522,-600475,4250042,3963692,
273663,74453,-6971,147700,119200,-405,-1882,-19,-1126,-49,44,76,11,101,3,-5,-5,-1,-9,0]);
const STOP_ROWS = new Float64Array([
0,33,46,74]);
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
/* The place xi between the marks of a side: 0 at its origin, 1 at the next. */
function place_of(side, c) {
	let q = (c - ORIGINS[side]) * SCALES[side];
	q = Math.sqrt(q > 0.0 ? q : 0.0);
	return 1.0 - Math.sqrt(q < 1.0 ? 1.0 - q : 0.0);
}
/* T, along, across, path length and body angle by look-up. */
function stop_table_at(c, delta, f) {
	let side = side_of(c);
	look_up(STOP, STOP_ROWS[side] * 5 * 5, STOP_ROWS[side + 1] - STOP_ROWS[side] - 3, 3, 5, 5,
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
